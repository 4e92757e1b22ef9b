#pragma once

// The room of the command line: a file for each verb, with its options and what it does. Here
// everything is put together (serve.cpp); nothing includes this room.

#include <functional>

namespace CLI {
class App;
}

namespace translucube::server {

/// What a verb does where the command line has it; gives the exit status.
struct Verb {
  CLI::App* command;
  std::function<int()> run;
};

// Each adds its verb and its options to the command line.
Verb add_render(CLI::App& app);
Verb add_sweep(CLI::App& app);
Verb add_develop(CLI::App& app);
Verb add_appearance(CLI::App& app);
Verb add_serve(CLI::App& app);
Verb add_token(CLI::App& app);

}  // namespace translucube::server

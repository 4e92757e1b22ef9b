#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "server/calls/tokens.h"
#include "server/cli/command.h"
#include "server/cli/verbs.h"

namespace translucube::server {
namespace {

/// Prints a new token and its entry for the file that server.tokens_file names.
int make(const std::string& name) {
  if (!is_token_name(name)) {
    std::cerr << "--name: must be letters, digits and . _ -, 64 at most\n";
    return exit_bad_request;
  }
  const NewToken made = make_token(name);
  std::cout << "token, shown this once:   " << made.token << '\n'
            << "entry of the tokens file: " << made.entry << '\n';
  return 0;
}

}  // namespace

Verb add_token(CLI::App& app) {
  const auto name = std::make_shared<std::string>();
  CLI::App* verb = app.add_subcommand("token", "Makes a token for who may use the service");
  verb->add_option("--name", *name, "Who will have it")->required();
  return {verb, [name] { return make(*name); }};
}

}  // namespace translucube::server

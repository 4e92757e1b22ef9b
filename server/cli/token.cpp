#include <CLI/CLI.hpp>
#include <memory>

#include "server/calls/tokens.h"
#include "server/cli/command.h"
#include "server/cli/output_files.h"
#include "server/cli/verbs.h"

namespace translucube::server {
namespace {

/// Prints a new token and its entry for the file that server.tokens_file names.
int make(const std::string& name) {
  if (!is_token_name(name))
    throw Refusal{exit_bad_request, "--name: must be letters, digits and . _ -, 64 at most\n"};
  const NewToken made = make_token(name);
  print("token, shown this once:   " + made.token + "\nentry of the tokens file: " + made.entry +
        '\n');
  return 0;
}

}  // namespace

Verb add_token(CLI::App& app) {
  const auto name = std::make_shared<std::string>();
  CLI::App* verb = app.add_subcommand("token", "Makes a token for who may use the service");
  verb->add_option("--name", *name, "Who will have it")->required();
  return {verb, [name] { return ended_command("token", [&] { return make(*name); }); }};
}

}  // namespace translucube::server

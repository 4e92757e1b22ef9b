#include <iostream>

#include "server/calls/tokens.h"
#include "server/cli/verbs.h"

namespace translucube::server {

int run_token(const std::string& name) {
  if (!is_token_name(name)) {
    std::cerr << "--name: must be letters, digits and . _ -, 64 at most\n";
    return exit_bad_request;
  }
  const NewToken made = make_token(name);
  std::cout << "token, shown this once:   " << made.token << '\n'
            << "entry of the tokens file: " << made.entry << '\n';
  return 0;
}

}  // namespace translucube::server

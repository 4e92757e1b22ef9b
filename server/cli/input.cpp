#include "server/cli/input.h"

#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>

#include "server/cli/command.h"

namespace translucube::server {

std::string read_input(const std::string& name, std::uint64_t limit) {
  std::ifstream file;
  if (name != "-") {
    if (std::filesystem::is_directory(name))
      throw Refusal{exit_bad_request, name + ": is a folder\n"};
    file.open(name, std::ios::binary);
    if (!file) throw Refusal{exit_bad_request, name + ": cannot be read\n"};
  }
  std::istream& in = name == "-" ? std::cin : file;
  std::string text;
  std::istreambuf_iterator<char> at(in), end;
  for (; at != end && text.size() <= limit; ++at) text += *at;
  return text;
}

}  // namespace translucube::server

#pragma once

#include <cstdio>
#include <string>

namespace translucube::speed {

struct ShellRun {
  bool succeeded = false;
  std::string output;  ///< standard output and error
};
/// A command line of the shell.
inline ShellRun run_shell(const std::string& command) {
  std::FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  if (!pipe) return {};
  ShellRun ran;
  char buffer[4096];
  for (std::size_t got; (got = std::fread(buffer, 1, sizeof buffer, pipe)) > 0;)
    ran.output.append(buffer, got);
  ran.succeeded = pclose(pipe) == 0;
  return ran;
}

inline bool is_installed(const std::string& program) {
  return run_shell("command -v " + program).succeeded;
}

}  // namespace translucube::speed

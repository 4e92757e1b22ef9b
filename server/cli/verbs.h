#pragma once

// The command line's verbs over plain options; main.cpp reads them.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace translucube::server {

inline constexpr int exit_failure = 1;      ///< the machine's fault
inline constexpr int exit_bad_request = 2;  ///< the caller's

/// The config that `--config` names, else $TRANSLUCUBE_CONFIG, else the one beside the build tree
/// of this executable, else the one of the source tree.
std::filesystem::path config_file(const std::string& named);

struct RenderOptions {
  std::string request;  ///< a file, or "-" for standard input
  std::vector<std::filesystem::path> outputs;
  std::optional<std::filesystem::path> stats, explorable_out;
  std::string config;
  std::optional<std::string> display, view;
  int threads = 0;  ///< 0: all cores
  std::optional<std::pair<int, int>> pixel;
  std::uint32_t sample = 0;
};

/// Renders, or explains one sample of one pixel. The exit status; messages go to standard error.
int run_render(const RenderOptions& options);

struct SweepOptions {
  std::string request;  ///< a file, or "-" for standard input
  std::filesystem::path folder;
  std::string config;
  std::optional<std::string> display, view;
  int threads = 0;  ///< 0: all cores
  bool dry_run = false;
};

/// Renders a sweep into a folder: each point as EXR and PNG, the contact sheet as sheet.exr and
/// sheet.png, and what was made of what as sweep.json. The exit status.
int run_sweep(const SweepOptions& options);

struct DevelopOptions {
  std::filesystem::path film;  ///< an explorable film, of --explorable-out
  std::vector<std::filesystem::path> outputs;
  std::string config;
  std::optional<std::string> display, view, absorber;
  std::optional<double> absorption;
  int threads = 0;  ///< 0: all cores
};

/// Develops an explorable film for another absorber. The exit status.
int run_develop(const DevelopOptions& options);

struct ServeOptions {
  std::string config;
  std::optional<std::string> host;
  std::optional<int> port, threads, workers;
  std::optional<std::filesystem::path> data, tokens;
};

/// Serves until SIGTERM or SIGINT. One line on standard output says where, once it is ready.
int run_serve(const ServeOptions& options);

/// Prints a new token and its entry for the file that server.tokens_file names. The exit status.
int run_token(const std::string& name);

}  // namespace translucube::server

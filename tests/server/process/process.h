#pragma once

// The real binary as a child process.

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "server/base/file.h"

namespace translucube::server::test {

class Process {
 public:
  /// Starts `arguments[0]`; `input` is its standard input.
  explicit Process(std::vector<std::string> arguments, const std::string& input = {}) {
    int in[2], out[2], err[2];
    if (::pipe2(in, O_CLOEXEC) != 0 || ::pipe2(out, O_CLOEXEC) != 0 || ::pipe2(err, O_CLOEXEC) != 0)
      throw std::runtime_error("no pipe");
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    pid_ = ::fork();
    if (pid_ == 0) {
      ::dup2(in[0], 0);
      ::dup2(out[1], 1);
      ::dup2(err[1], 2);
      ::execv(argv[0], argv.data());
      ::_exit(127);
    }
    ::close(in[0]);
    ::close(out[1]);
    ::close(err[1]);
    output_ = FileDescriptor(out[0]);
    errors_ = FileDescriptor(err[0]);
    // Small enough for a pipe's buffer.
    if (::write(in[1], input.data(), input.size()) < 0) throw std::runtime_error("no input");
    ::close(in[1]);
    reader_ = std::jthread([this] { drain(errors_.get(), error_text_); });
  }
  ~Process() {
    if (pid_ > 0) {
      kill(SIGKILL);
      wait();
    }
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  /// True once the process takes this signal as a call instead of dying of it.
  bool blocks(int signal) const {
    std::ifstream status("/proc/" + std::to_string(pid_) + "/status");
    for (std::string text; std::getline(status, text);)
      if (text.starts_with("SigBlk:"))
        return (std::stoull(text.substr(7), nullptr, 16) >> (signal - 1) & 1) != 0;
    return false;
  }

  pid_t pid() const { return pid_; }
  void kill(int signal) const { ::kill(pid_, signal); }

  /// A line of standard output, "" at its end.
  std::string line() const {
    std::string text;
    char c;
    while (::read(output_.get(), &c, 1) == 1 && c != '\n') text += c;
    return text;
  }

  /// The exit status, or minus the signal that ended it. Standard output and error are whole then.
  int wait() {
    drain(output_.get(), output_text_);
    int status = 0;
    ::waitpid(pid_, &status, 0);
    pid_ = -1;
    if (reader_.joinable()) reader_.join();
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }
  const std::string& output() const { return output_text_; }
  const std::string& errors() const { return error_text_; }

 private:
  static void drain(int fd, std::string& text) {
    char buffer[4096];
    for (ssize_t got; (got = ::read(fd, buffer, sizeof buffer)) > 0;)
      text.append(buffer, static_cast<std::size_t>(got));
  }

  pid_t pid_ = -1;
  FileDescriptor output_, errors_;
  std::string output_text_, error_text_;
  std::jthread reader_;
};

/// The exit status of the whole binary's run.
struct Ran {
  int status;
  std::string output, errors;
};
inline Ran run_translucube(std::vector<std::string> arguments, const std::string& input = {}) {
  arguments.insert(arguments.begin(), TRANSLUCUBE_BINARY);
  Process process(std::move(arguments), input);
  const int status = process.wait();
  return {status, process.output(), process.errors()};
}

}  // namespace translucube::server::test

#pragma once

#include <functional>
#include <string>

#include "server/base/file.h"

namespace translucube::server {

/// A TCP port that is listened on.
class Listener {
 public:
  /// Connections queue up from here on. Port 0: any free one. Throws ListenError if the port cannot
  /// be had.
  Listener(const std::string& host, int port);

  int port() const;
  /// The next connection; empty once stopped. Where the process has no descriptor left for it,
  /// `make_room` is to close one, and says whether it could.
  FileDescriptor next(const std::function<bool()>& make_room);
  void stop();  ///< from any thread, before or after

 private:
  bool rings_within(int milliseconds) const;

  FileDescriptor socket_, bell_;
};

}  // namespace translucube::server

#pragma once

// What keeps accepted work from being done and is nobody's fault: a full disk, a folder that is
// away, a thread that cannot be had. The work waits until it has passed.

#include <chrono>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>

namespace translucube::server {

struct Setback : std::runtime_error {
  /// Of the disk, of what else the service itself has, or of a file that the request names.
  enum class Of { disk, service, request };
  Of of;
  std::string told;  ///< to whoever asks whether the service is ready: no inner detail
  Setback(Of whose, std::string to_clients, const std::string& what)
      : std::runtime_error(what), of(whose), told(std::move(to_clients)) {}
};

/// The jobs that wait so. Safe to share by threads.
class Setbacks {
 public:
  /// The job waits for so long; how often it has in a row.
  int add(const std::string& job_id, const Setback& setback, std::chrono::milliseconds wait);
  void clear(const std::string& job_id);  ///< it goes on, or has ended

  /// Why work waits for the disk, for the second time in a row; empty if none does.
  std::optional<std::string> of_disk() const;
  /// The same for the disk or something else of the service.
  std::optional<std::string> of_service() const;
  std::uint64_t count() const;

 private:
  using Clock = std::chrono::steady_clock;
  struct Entry {
    Setback::Of of = Setback::Of::service;
    std::string told;
    int times = 0;
    Clock::time_point until;  ///< then it was tried again, or is no more
  };
  std::optional<std::string> told_of(bool (*of)(Setback::Of), int least) const;

  mutable std::mutex mutex_;
  std::map<std::string, Entry> entries_;
};

}  // namespace translucube::server

#include "server/worker/setbacks.h"

#include <algorithm>

namespace translucube::server {
namespace {

// A job that is due again may wait for a worker first.
constexpr std::chrono::seconds longest_wait_for_a_worker(60);

}  // namespace

int Setbacks::add(const std::string& job_id, const Setback& setback,
                  std::chrono::milliseconds wait) {
  const auto now = Clock::now();
  const std::lock_guard lock(mutex_);
  std::erase_if(entries_, [&](const auto& entry) { return entry.second.until < now; });
  Entry& entry = entries_[job_id];
  entry = {setback.of, setback.told, entry.times + 1, now + wait + longest_wait_for_a_worker};
  return entry.times;
}

void Setbacks::clear(const std::string& job_id) {
  const std::lock_guard lock(mutex_);
  entries_.erase(job_id);
}

std::optional<std::string> Setbacks::told_of(bool (*of)(Setback::Of), int least) const {
  const auto now = Clock::now();
  const std::lock_guard lock(mutex_);
  for (const auto& [id, entry] : entries_)
    if (of(entry.of) && entry.times >= least && entry.until >= now) return entry.told;
  return std::nullopt;
}

std::optional<std::string> Setbacks::of_disk() const {
  return told_of([](Setback::Of of) { return of == Setback::Of::disk; }, 2);
}

std::optional<std::string> Setbacks::of_service() const {
  return told_of([](Setback::Of of) { return of != Setback::Of::request; }, 1);
}

std::uint64_t Setbacks::count() const {
  const auto now = Clock::now();
  const std::lock_guard lock(mutex_);
  return static_cast<std::uint64_t>(std::ranges::count_if(
      entries_, [&](const auto& entry) { return entry.second.until >= now; }));
}

}  // namespace translucube::server

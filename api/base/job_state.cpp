#include "api/base/job_state.h"

namespace translucube::api {

std::string_view name(JobState state) {
  switch (state) {
    case JobState::queued:
      return "queued";
    case JobState::running:
      return "running";
    case JobState::succeeded:
      return "succeeded";
    case JobState::failed:
      return "failed";
    case JobState::canceled:
      return "canceled";
  }
  return "";
}

std::optional<JobState> job_state(std::string_view text) {
  for (const JobState state : all_job_states)
    if (name(state) == text) return state;
  return std::nullopt;
}

bool is_end(JobState state) {
  return state == JobState::succeeded || state == JobState::failed || state == JobState::canceled;
}

bool may_follow(JobState from, JobState to) {
  switch (from) {
    case JobState::queued:
      return to == JobState::running || to == JobState::canceled;
    case JobState::running:
      return to == JobState::queued || is_end(to);
    case JobState::succeeded:
    case JobState::failed:
    case JobState::canceled:
      return false;
  }
  return false;
}

}  // namespace translucube::api

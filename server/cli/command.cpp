#include "server/cli/command.h"

#include <iostream>
#include <new>

#include "renderer/scene/spec.h"
#include "server/base/signals.h"

namespace translucube::server {

Refusal refusal_of(const api::Problem& problem) { return {exit_bad_request, to_text(problem)}; }

void refuse_nan(const RenderStats& stats) {
  if (stats.nan_samples > 0)
    throw Refusal{exit_failure, "The renderer made " + std::to_string(stats.nan_samples) +
                                    " samples that are not finite: a bug, please report it.\n"};
}

int ended_command(const char* made, const std::function<int()>& verb) {
  try {
    return verb();
  } catch (const Refusal& refusal) {
    std::cerr << refusal.message;
    return refusal.status;
  } catch (const SceneError& error) {
    std::cerr << error.what() << '\n';
    return exit_bad_request;
  } catch (const std::bad_alloc&) {
    std::cerr << "There is not enough memory for a " << made << " of this size.\n";
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
  }
  return exit_failure;
}

int interruptible_command(const char* made, const std::function<int(const Interruption&)>& verb) {
  std::stop_source stop;
  std::atomic<int> signal = 0;
  const SignalWatch watch([&](int received) {
    signal = received;
    stop.request_stop();
  });
  return ended_command(made, [&] { return verb({stop.get_token(), signal}); });
}

}  // namespace translucube::server

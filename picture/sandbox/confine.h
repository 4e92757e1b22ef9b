#pragma once

// The inside of the sandbox: what its process does before it looks at the first byte.

#include <cstddef>
#include <exception>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace translucube {

/// The descriptors that the process is started with.
inline constexpr int sandbox_file = 3, sandbox_answer = 4;
/// Its exit statuses beside 0.
inline constexpr int sandbox_not_confined = 70, sandbox_no_answer = 71;

/// Takes what was read apart into pieces that are written one after the other.
using AnswerPieces = std::vector<std::span<const std::byte>>;

/// The whole life of the process: reads the file, lets `prepare` load what is needed to parse it
/// (and may not look at it further than to know its format), gives up all rights, and answers with
/// what `parse` hands to `answer`, or with the text of its exception. Returns the exit status.
int run_confined(
    const std::function<void(std::span<const char>)>& prepare,
    const std::function<void(std::span<const char>,
                             const std::function<void(const AnswerPieces&)>& answer)>& parse);

}  // namespace translucube

#pragma once

// The bytes between the process in the sandbox and the one that started it.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>

namespace translucube {

/// Stands before what was read, or before the reason why nothing was (UTF-8, at most
/// `longest_reason` bytes).
struct AnswerHead {
  enum class Kind : std::uint32_t { read = 1, refused = 2 };
  std::array<char, 8> magic{'T', 'L', 'C', 'R', 'E', 'A', 'D', '1'};
  Kind kind = Kind::read;
  std::uint32_t reserved = 0;
  std::uint64_t bytes = 0;  ///< behind the head
};
inline constexpr std::size_t longest_reason = 2000;

/// What is no answer.
struct AnswerError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Takes values off an answer, never more than there are. Throws AnswerError.
class AnswerReader {
 public:
  explicit AnswerReader(std::span<const std::byte> bytes) : rest_(bytes) {}

  template <class T>
  T value() {
    static_assert(std::is_trivially_copyable_v<T>);
    T result;
    std::memcpy(&result, take(sizeof(T)).data(), sizeof(T));
    return result;
  }

  /// Fills `out`, which somebody sized by what remains().
  template <class T>
  void values(std::span<T> out) {
    static_assert(std::is_trivially_copyable_v<T>);
    const auto bytes = take(out.size_bytes());
    if (!bytes.empty()) std::memcpy(out.data(), bytes.data(), bytes.size());
  }

  std::span<const std::byte> take(std::size_t count) {
    if (count > rest_.size()) throw AnswerError("an answer that ends too soon");
    const auto bytes = rest_.first(count);
    rest_ = rest_.subspan(count);
    return bytes;
  }

  std::size_t remains() const { return rest_.size(); }
  void expect_end() const {
    if (!rest_.empty()) throw AnswerError("an answer with more behind it");
  }

 private:
  std::span<const std::byte> rest_;
};

/// What an answer holds behind its head. Throws AnswerError, or FileRefused with the reason that it
/// gives.
std::span<const std::byte> open_answer(std::span<const std::byte> answer);

}  // namespace translucube

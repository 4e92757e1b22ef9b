#pragma once

// The body of a request: of a length, or in chunks (RFC 9112, 7.1). A pure function of the bytes
// as they come, however they are cut.

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "api/base/problem.h"
#include "server/http/request_head.h"

namespace translucube::server {

class BodyReader {
 public:
  /// What a client may send, at least, of a body that is too large, so that it gets to read the
  /// answer [bytes].
  static constexpr std::uint64_t longest_drain = std::uint64_t(1) << 30;

  /// Past `limit` bytes [of data] the body is read on, so that its end is found, but not kept.
  BodyReader(const Framing& framing, std::uint64_t limit)
      : state_(framing.chunked ? State::size_line : State::length),
        left_(framing.length),
        limit_(limit) {
    if (!framing.has_body()) state_ = State::whole;
  }

  /// From here on the data, at most `limit` bytes of it, goes to `sink` and not to memory. A
  /// FileError of the sink is a fault.
  using Sink = std::function<void(std::string_view)>;
  void pour_into(Sink sink, std::uint64_t limit) {
    sink_ = std::move(sink);
    limit_ = limit;
  }

  /// Takes bytes from the front, up to the body's end. Trailer fields are dropped (RFC
  /// 9110, 6.5.1).
  void take(std::string_view& bytes);

  bool whole() const { return state_ == State::whole; }
  const std::optional<api::Problem>& fault() const { return fault_; }
  bool too_large() const { return received_ > limit_; }
  std::uint64_t limit() const { return limit_; }
  std::uint64_t received() const { return received_; }  ///< bytes of data
  std::size_t held() const { return text_.capacity(); }
  /// The data, of a body that is whole and went to memory; the sink is no longer held.
  std::string release() {
    sink_ = nullptr;
    return std::move(text_);
  }

 private:
  enum class State { length, size_line, data, data_end, trailer, whole, faulty };

  void take_data(std::string_view& bytes);
  bool keep(std::string_view data);
  bool take_line(std::string_view& bytes, std::size_t longest);
  void end_line();
  void refuse(api::ProblemCode code, const char* detail);

  State state_;
  std::uint64_t left_;  ///< of the body or the chunk
  std::uint64_t limit_;
  Sink sink_;
  std::uint64_t received_ = 0;
  std::size_t extensions_ = 0, trailers_ = 0;  ///< bytes of all
  std::string line_, text_;
  std::optional<api::Problem> fault_;
};

}  // namespace translucube::server

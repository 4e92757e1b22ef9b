#include "server/http/body_reader.h"

#include <algorithm>

#include "api/base/text.h"
#include "server/base/file.h"
#include "server/http/grammar.h"

namespace translucube::server {
namespace {

using api::ProblemCode;

// RFC 9112, 7.1.1 and 7.1.2: extensions and trailers must be bounded, or a small body could keep a
// server reading.
constexpr std::size_t longest_size_line = 1 << 12;
constexpr std::size_t most_extensions = 1 << 14;
constexpr std::size_t most_trailers = 1 << 13;

void skip_blanks(std::string_view& text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
}

std::string_view take_token(std::string_view& text) {
  const auto end = std::ranges::find_if_not(text, is_token_character);
  const std::string_view token = text.substr(0, static_cast<std::size_t>(end - text.begin()));
  text.remove_prefix(token.size());
  return token;
}

/// A quoted string (RFC 9110, 5.6.4). False where it does not begin here or does not end.
bool take_quoted(std::string_view& text) {
  for (std::size_t i = 1; text.starts_with('"') && i < text.size(); ++i) {
    if (text[i] == '\\') {
      ++i;
    } else if (text[i] == '"') {
      text.remove_prefix(i + 1);
      return true;
    }
  }
  return false;
}

/// *( BWS ";" BWS name [ BWS "=" BWS ( token / quoted-string ) ] )
bool are_extensions(std::string_view text) {
  while (!text.empty()) {
    skip_blanks(text);
    if (!text.starts_with(';')) return false;
    text.remove_prefix(1);
    skip_blanks(text);
    if (take_token(text).empty()) return false;
    std::string_view after = text;
    skip_blanks(after);
    if (!after.starts_with('=')) continue;
    text = after.substr(1);
    skip_blanks(text);
    if (!take_quoted(text) && take_token(text).empty()) return false;
  }
  return true;
}

}  // namespace

void BodyReader::refuse(ProblemCode code, const char* detail) {
  state_ = State::faulty;
  text_.clear();
  fault_ = api::Problem{code, detail, {}};
}

void BodyReader::take(std::string_view& bytes) {
  while (!bytes.empty()) switch (state_) {
      case State::length:
      case State::data:
        take_data(bytes);
        break;
      case State::size_line:
        if (line_.empty() && !is_hex_digit(bytes.front()))
          return refuse(ProblemCode::malformed_http, "A chunk has no size.");
        if (take_line(bytes, longest_size_line)) end_line();
        break;
      case State::data_end:
        if (take_line(bytes, 0)) end_line();
        break;
      case State::trailer:
        if (take_line(bytes, most_trailers)) end_line();
        break;
      case State::whole:
      case State::faulty:
        return;
    }
}

void BodyReader::take_data(std::string_view& bytes) {
  const std::string_view data = bytes.substr(0, left_);
  bytes.remove_prefix(data.size());
  left_ -= data.size();
  received_ += data.size();
  if (!keep(data))
    return refuse(ProblemCode::storage_failure,
                  "The disk of the service is full or cannot be used.");
  if (received_ > std::max(longest_drain, limit_))
    return refuse(ProblemCode::payload_too_large, "The body is too large.");
  if (left_ == 0) state_ = state_ == State::length ? State::whole : State::data_end;
}

/// False where it cannot be written.
bool BodyReader::keep(std::string_view data) {
  if (too_large()) {
    text_ = {};
    sink_ = nullptr;
  } else if (!sink_) {
    text_ += data;
  } else
    try {
      sink_(data);
    } catch (const FileError&) {
      return false;
    }
  return true;
}

/// True once `line_` is whole, without its CR LF.
bool BodyReader::take_line(std::string_view& bytes, std::size_t longest) {
  while (!bytes.empty()) {
    const char byte = bytes.front();
    bytes.remove_prefix(1);
    const bool after_cr = line_.ends_with('\r');
    if (after_cr && byte == '\n') {
      line_.pop_back();
      return true;
    }
    const bool control = (byte >= 0 && byte < ' ' && byte != '\t' && byte != '\r') || byte == 0x7f;
    if (after_cr || control) {
      refuse(ProblemCode::malformed_http, "A line of the chunked body does not end in CR LF.");
      return false;
    }
    if (byte != '\r' && line_.size() >= longest) {
      if (longest == 0)
        refuse(ProblemCode::malformed_http, "A chunk is longer than its size.");
      else
        refuse(ProblemCode::headers_too_large,
               "The body's chunk extensions or trailers are too long.");
      return false;
    }
    line_ += byte;
  }
  return false;
}

void BodyReader::end_line() {
  std::string_view line = line_;
  if (state_ == State::data_end) {
    state_ = State::size_line;
  } else if (state_ == State::trailer) {
    trailers_ += line.size();
    if (line.empty())
      state_ = State::whole;
    else if (trailers_ > most_trailers)
      return refuse(ProblemCode::headers_too_large, "The trailers are too long.");
    else if (!read_field_line(line))
      return refuse(ProblemCode::malformed_http, "A trailer is not \"name: value\".");
  } else {
    const auto end = std::ranges::find_if_not(line, is_hex_digit);
    const std::string_view digits = line.substr(0, static_cast<std::size_t>(end - line.begin()));
    line.remove_prefix(digits.size());
    extensions_ += line.size();
    // A size that no 64 bits hold is refused, not wrapped.
    const auto size = api::number_of<std::uint64_t>(digits, 16);
    if (!size || !are_extensions(line))
      return refuse(ProblemCode::malformed_http, "A chunk has no size.");
    if (extensions_ > most_extensions)
      return refuse(ProblemCode::headers_too_large, "The chunk extensions are too long.");
    left_ = *size;
    state_ = left_ > 0 ? State::data : State::trailer;
  }
  line_.clear();
}

}  // namespace translucube::server

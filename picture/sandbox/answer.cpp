#include "picture/sandbox/answer.h"

#include "picture/sandbox/sandbox.h"

namespace translucube {

std::span<const std::byte> open_answer(std::span<const std::byte> answer) {
  AnswerReader reader(answer);
  const auto head = reader.value<AnswerHead>();
  if (head.magic != AnswerHead{}.magic || head.bytes != reader.remains())
    throw AnswerError("no answer");
  if (head.kind == AnswerHead::Kind::read) return reader.take(reader.remains());
  if (head.kind != AnswerHead::Kind::refused || head.bytes > longest_reason)
    throw AnswerError("no answer");
  const auto text = reader.take(reader.remains());
  std::string reason(reinterpret_cast<const char*>(text.data()), text.size());
  // It goes into logs and JSON.
  std::ranges::replace_if(
      reason, [](unsigned char c) { return c < 32 || c > 126; }, '?');
  throw FileRefused(reason);
}

}  // namespace translucube

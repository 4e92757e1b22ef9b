#include "server/base/ids.h"

#include <sys/random.h>

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <vector>

namespace translucube::server {
namespace {

constexpr std::string_view alphabet = "0123456789ABCDEFGHJKMNPQRSTVWXYZ";
constexpr int id_length = 26;
constexpr int random_bits = 80;

void fill_random(void* bytes, std::size_t size) {
  auto* at = static_cast<unsigned char*>(bytes);
  while (size > 0) {
    const ssize_t got = getrandom(at, size, 0);
    if (got < 0) {
      if (errno == EINTR) continue;
      throw std::system_error(errno, std::generic_category(), "getrandom");
    }
    at += got;
    size -= static_cast<std::size_t>(got);
  }
}

}  // namespace

std::string hex(std::span<const unsigned char> bytes) {
  std::string text;
  for (const unsigned char byte : bytes) {
    text += "0123456789abcdef"[byte >> 4];
    text += "0123456789abcdef"[byte & 15];
  }
  return text;
}

std::string random_hex(int bytes) {
  std::vector<unsigned char> raw(static_cast<std::size_t>(bytes));
  fill_random(raw.data(), raw.size());
  return hex(raw);
}

std::string content_hash(std::string_view bytes) {
  // FNV-1a, 64 bits (Fowler, Noll, Vo).
  std::uint64_t value = 0xcbf29ce484222325u;
  for (const char c : bytes) value = (value ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  std::string text;
  for (int shift = 60; shift >= 0; shift -= 4) text += "0123456789abcdef"[value >> shift & 15];
  return text;
}

bool is_id(std::string_view text) {
  // 26 x 5 = 130 bits: the first character carries only three.
  return text.size() == id_length && text[0] <= '7' &&
         std::ranges::all_of(text, [](char c) { return alphabet.find(c) != alphabet.npos; });
}

IdSource::IdSource(std::string_view last) {
  if (!is_id(last)) return;
  for (const char c : last) last_ = last_ << 5 | static_cast<unsigned>(alphabet.find(c));
}

std::string IdSource::next(std::int64_t now_ms) {
  unsigned char random[random_bits / 8];
  fill_random(random, sizeof random);

  const std::lock_guard lock(mutex_);
  Bits id = static_cast<Bits>(std::max<std::int64_t>(now_ms, 0));
  for (const unsigned char byte : random) id = id << 8 | byte;
  if (id >> random_bits <= last_ >> random_bits) {
    // The same millisecond, or a clock set back: a random step onwards keeps order and secrecy.
    Bits step = 1;
    for (int i = 0; i < 8; ++i) step += static_cast<Bits>(random[i]) << (8 * i);
    id = last_ + step;
  }
  last_ = id;

  std::string text(id_length, '0');
  for (int i = id_length - 1; i >= 0; --i, id >>= 5)
    text[static_cast<std::size_t>(i)] = alphabet[static_cast<std::size_t>(id & 31)];
  return text;
}

}  // namespace translucube::server

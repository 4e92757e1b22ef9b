#include "server/calls/tokens.h"

#include <openssl/crypto.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <optional>

#include "api/base/field_reader.h"
#include "api/base/json_reader.h"
#include "api/base/text.h"
#include "server/base/ids.h"

namespace translucube::server {
namespace {

constexpr std::uint64_t largest_file_bytes = 1 << 20;
constexpr int token_bytes = 32;

std::optional<Sha256> from_hex(std::string_view text) {
  Sha256 hash{};
  if (text.size() != 2 * hash.size()) return std::nullopt;
  for (std::size_t i = 0; i < hash.size(); ++i) {
    const auto byte = api::number_of<unsigned char>(text.substr(2 * i, 2), 16);
    if (!byte) return std::nullopt;
    hash[i] = *byte;
  }
  return hash;
}

void read_token(const nlohmann::json& value, const std::string& pointer, std::vector<Token>& tokens,
                api::Faults& faults) {
  api::FieldReader object(value, pointer, faults);
  const auto name = object.string("name", api::Presence::required);
  const auto text = object.string("sha256", api::Presence::required);
  object.refuse_unknown_keys();
  if (name && !is_token_name(*name))
    object.fault("name", "must be letters, digits and . _ -, 64 at most");
  const auto hash = text ? from_hex(*text) : std::nullopt;
  if (text && !hash) object.fault("sha256", "must be 64 hexadecimal digits");
  if (!name || !hash) return;
  for (const Token& other : tokens) {
    if (other.name == *name) object.fault("name", "is there already");
    if (other.hash == *hash) object.fault("sha256", "is there already");
  }
  tokens.push_back({*name, *hash});
}

}  // namespace

bool is_token_name(std::string_view name) {
  return !name.empty() && name.size() <= 64 && std::ranges::all_of(name, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' ||
           c == '_' || c == '-';
  });
}

std::vector<Token> load_tokens(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::error_code error;
  if (!stream || !std::filesystem::is_regular_file(file, error))
    throw TokensError(file.string() + " cannot be opened for reading");
  std::string text{std::istreambuf_iterator<char>(stream), {}};
  auto read = api::read_json(text, largest_file_bytes);
  if (!read) throw TokensError(file.string() + ": " + to_text(read.problem()));
  auto& [document, faults] = *read;

  std::vector<Token> tokens;
  api::FieldReader object(document, "", faults);
  const nlohmann::json* list = object.find("tokens", api::Presence::required);
  object.refuse_unknown_keys();
  if (list && !list->is_array()) object.fault("tokens", "must be an array");
  for (std::size_t i = 0; list && list->is_array() && i < list->size(); ++i)
    read_token((*list)[i], "/tokens/" + std::to_string(i), tokens, faults);
  if (list && list->is_array() && list->empty()) object.fault("tokens", "is empty");
  if (!faults.empty())
    throw TokensError(file.string() + " is no usable file of tokens\n" +
                      to_text(invalid_request(faults)));
  return tokens;
}

std::string_view name_of(const std::vector<Token>& tokens, std::string_view presented) {
  const Sha256 hash = sha256(presented);
  std::string_view name;
  for (const Token& token : tokens)
    if (CRYPTO_memcmp(token.hash.data(), hash.data(), hash.size()) == 0) name = token.name;
  return name;
}

NewToken make_token(std::string_view name) {
  std::string token = random_hex(token_bytes);
  std::string entry =
      R"({"name":")" + std::string(name) + R"(","sha256":")" + hex(sha256(token)) + R"("})";
  return {std::move(token), std::move(entry)};
}

}  // namespace translucube::server

#pragma once

#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "server/base/sha256.h"

namespace translucube::server {

/// One who may use the service. The token itself is nowhere: it has 256 random bits, so that a
/// plain hash tells nothing of it.
struct Token {
  std::string name;
  Sha256 hash;
};

struct TokensError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Reads {"tokens": [{"name": "ci", "sha256": "<64 hexadecimal digits>"}]}: at least one, each of
/// its own name and hash. Throws TokensError, which says where the fault is.
std::vector<Token> load_tokens(const std::filesystem::path& file);

/// The name of the token, "" if it is none of them. Takes the same time whichever it is.
std::string_view name_of(const std::vector<Token>& tokens, std::string_view presented);

/// Letters, digits and . _ -, 64 at most: it stands in log lines.
bool is_token_name(std::string_view name);

/// A token never seen before, and its entry for the file.
struct NewToken {
  std::string token, entry;
};
NewToken make_token(std::string_view name);

}  // namespace translucube::server

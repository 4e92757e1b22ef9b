#include "server/base/sha256.h"

#include <openssl/evp.h>

#include <stdexcept>

namespace translucube::server {

Sha256 sha256(std::string_view bytes) {
  Sha256 hash{};
  if (EVP_Digest(bytes.data(), bytes.size(), hash.data(), nullptr, EVP_sha256(), nullptr) != 1)
    throw std::runtime_error("SHA-256 failed");
  return hash;
}

}  // namespace translucube::server

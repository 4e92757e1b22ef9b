#include "server/base/sha256.h"

#include <openssl/evp.h>

#include <new>
#include <stdexcept>

namespace translucube::server {

Sha256 sha256(std::string_view bytes) {
  Sha256 hash{};
  if (EVP_Digest(bytes.data(), bytes.size(), hash.data(), nullptr, EVP_sha256(), nullptr) != 1)
    throw std::runtime_error("SHA-256 failed");
  return hash;
}

namespace {

void check(int done) {
  if (done != 1) throw std::runtime_error("SHA-256 failed");
}

}  // namespace

void Sha256Sum::Free::operator()(evp_md_ctx_st* context) const { EVP_MD_CTX_free(context); }

Sha256Sum::Sha256Sum() : context_(EVP_MD_CTX_new()) {
  if (!context_) throw std::bad_alloc();
  check(EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr));
}

void Sha256Sum::add(std::string_view bytes) {
  check(EVP_DigestUpdate(context_.get(), bytes.data(), bytes.size()));
}

Sha256 Sha256Sum::sum() {
  Sha256 hash{};
  check(EVP_DigestFinal_ex(context_.get(), hash.data(), nullptr));
  return hash;
}

}  // namespace translucube::server

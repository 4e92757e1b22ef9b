#pragma once

#include <array>
#include <memory>
#include <string_view>

struct evp_md_ctx_st;

namespace translucube::server {

using Sha256 = std::array<unsigned char, 32>;

/// FIPS 180-4. Throws std::runtime_error if the library cannot.
Sha256 sha256(std::string_view bytes);

/// Of bytes that come in parts.
class Sha256Sum {
 public:
  Sha256Sum();
  void add(std::string_view bytes);
  Sha256 sum();  ///< once

 private:
  struct Free {
    void operator()(evp_md_ctx_st* context) const;
  };
  std::unique_ptr<evp_md_ctx_st, Free> context_;
};

}  // namespace translucube::server

#include "server/content.h"

#include <openssl/evp.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <memory>
#include <stdexcept>

namespace translucube::server {
namespace {

/// FIPS 180-4. Each part is preceded by its length: no two lists of parts look the same.
class Sha256 {
 public:
  Sha256() : context_(EVP_MD_CTX_new(), EVP_MD_CTX_free) {
    if (!context_ || EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr) != 1)
      throw std::runtime_error("SHA-256 cannot be had");
  }
  void add(std::string_view part) {
    const std::uint64_t size = part.size();
    EVP_DigestUpdate(context_.get(), &size, sizeof size);
    EVP_DigestUpdate(context_.get(), part.data(), part.size());
  }
  void add(const std::vector<double>& values) {
    add({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(double)});
  }
  std::string hex() {
    std::array<unsigned char, 32> digest{};
    EVP_DigestFinal_ex(context_.get(), digest.data(), nullptr);
    std::string text;
    for (const unsigned char byte : digest) {
      text += "0123456789abcdef"[byte >> 4];
      text += "0123456789abcdef"[byte & 15];
    }
    return text;
  }

 private:
  std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context_;
};

void add_file(Sha256& hash, const std::filesystem::path& file) {
  struct stat info {};
  if (::stat(file.c_str(), &info) != 0) return;  // whoever traces it will tell
  hash.add(std::to_string(info.st_size) + ' ' + std::to_string(info.st_mtim.tv_sec) + '.' +
           std::to_string(info.st_mtim.tv_nsec));
}

}  // namespace

std::string content_key(const api::RenderRequest& request, std::string_view canonical,
                        const api::Catalog& catalog, std::string_view traced_with) {
  Sha256 hash;
  hash.add(engine_version());
  hash.add(canonical);
  hash.add(traced_with);
  if (const auto* name = std::get_if<std::string>(&request.material.absorber)) {
    const auto found = catalog.absorbers.find(*name);
    if (found != catalog.absorbers.end()) {
      hash.add(found->second.spectrum.wavelengths_nm);
      hash.add(found->second.spectrum.values);
    }
  }
  const auto& source = request.environment.source;
  if (const auto* named = std::get_if<api::NamedEnvironment>(&source)) {
    const auto found = catalog.environments.find(named->image);
    if (found != catalog.environments.end()) add_file(hash, found->second);
  }
  if (const auto* own = std::get_if<api::FileEnvironment>(&source)) add_file(hash, own->file);
  if (const auto* mesh = std::get_if<api::MeshRequest>(&request.object)) add_file(hash, mesh->file);
  return hash.hex();
}

bool is_content_key(std::string_view text) {
  return text.size() == 64 && std::ranges::all_of(text, [](char c) {
           return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f');
         });
}

}  // namespace translucube::server

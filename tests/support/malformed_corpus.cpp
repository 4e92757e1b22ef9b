#include "tests/support/malformed_corpus.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

#include "tests/support/repository.h"

namespace translucube::test {
namespace {

constexpr std::size_t million = 1'000'000;
constexpr std::size_t mebibyte = 1 << 20;  // limits.body_bytes

std::string file_text(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw std::runtime_error("cannot read " + file.string());
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::string repeated(const std::string& piece, std::size_t times) {
  std::string text;
  text.reserve(piece.size() * times);
  for (std::size_t i = 0; i < times; ++i) text += piece;
  return text;
}

std::string steps(const std::string& step) { return repeated(step, 16); }

/// {"material": ..., "kI": VALUE, ...} of almost a mebibyte.
std::string with_many_keys(const std::string& value) {
  std::string text = R"({"material":{"cube":{"absorption":0,"roughness":0,"scattering":0}})";
  for (std::size_t i = 0; text.size() < mebibyte - 64; ++i)
    text.append(",\"k").append(std::to_string(i)).append("\":").append(value);
  return text + "}";
}

void add_generated(std::vector<MalformedBody>& bodies) {
  const std::string head = R"({"material":{"cube":{"absorption":0,"roughness":0,"scattering":0}},)";
  bodies.push_back({"64-mebibytes-of-spaces", std::string(64 * mebibyte, ' '), 413, ""});
  bodies.push_back({"64-mebibytes-of-brackets", std::string(64 * mebibyte, '['), 413, ""});
  bodies.push_back({"one-byte-too-many", std::string(mebibyte + 1, ' '), 413, ""});
  bodies.push_back({"million-brackets", std::string(million, '['), 422, steps("/0")});
  bodies.push_back({"half-a-million-closed-brackets",
                    std::string(million / 2, '[') + std::string(million / 2, ']'), 422,
                    steps("/0")});
  bodies.push_back(
      {"two-hundred-thousand-objects", repeated(R"({"a":)", million / 5), 422, steps("/a")});
  bodies.push_back({"million-brackets-in-unknown-key", head + "\"x\":" + std::string(million, '['),
                    422, "/x" + repeated("/0", 15)});
  bodies.push_back({"mebibyte-of-spaces", std::string(mebibyte, ' '), 400, ""});
  bodies.push_back({"mebibyte-of-quotes", std::string(mebibyte, '"'), 400, ""});
  bodies.push_back({"mebibyte-of-zero-bytes", std::string(mebibyte, '\0'), 400, ""});
  bodies.push_back({"mebibyte-of-backslashes", "\"" + std::string(mebibyte - 1, '\\'), 400, ""});
  bodies.push_back(
      {"million-digit-seed", head + "\"seed\":" + std::string(million, '9') + "}", 422, "/seed"});
  bodies.push_back({"million-character-model",
                    head + "\"model\":\"" + std::string(million, 'x') + "\"}", 422, "/model"});
  bodies.push_back({"million-character-key", head + "\"" + std::string(million, 'k') + "\":1}", 422,
                    "/" + std::string(64, 'k') + "..."});
  bodies.push_back({"hundred-thousand-unknown-keys", with_many_keys("1"), 422, "/k0"});
  bodies.push_back({"many-numbers-too-large", with_many_keys("1e999"), 422, "/k0"});
  bodies.push_back({"hundred-thousand-duplicate-keys",
                    head + repeated("\"seed\":1,", 100'000) + "\"seed\":1}", 422, "/seed"});
  bodies.push_back({"half-a-million-wavelengths",
                    R"({"material":{"cube":{"absorption":0,"roughness":0,"scattering":0},)"
                    R"("absorber":{"wavelengths_nm":[)" +
                        repeated("1,", 500'000) + R"(1],"values":[1,1]}}})",
                    422, "/material/absorber/wavelengths_nm"});
}

}  // namespace

std::vector<MalformedBody> malformed_bodies() {
  const std::filesystem::path folder = in_repository("tests/api/malformed");
  std::istringstream index(file_text(folder / "index.txt"));
  std::vector<MalformedBody> bodies;
  for (std::string line; std::getline(index, line);) {
    if (line.empty() || line.starts_with('#')) continue;
    std::istringstream fields(line);
    MalformedBody body;
    std::string pointer;
    if (!(fields >> body.name >> body.status))
      throw std::runtime_error("bad line in the malformed corpus: " + line);
    if (std::getline(fields >> std::ws, pointer))
      body.pointer = nlohmann::json::parse(pointer).get<std::string>();
    body.text = file_text(folder / body.name);
    bodies.push_back(std::move(body));
  }
  add_generated(bodies);
  return bodies;
}

}  // namespace translucube::test

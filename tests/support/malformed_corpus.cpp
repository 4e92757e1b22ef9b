#include "tests/support/malformed_corpus.h"

#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "tests/support/repository.h"

namespace translucube::test {
namespace {

constexpr std::size_t million = 1'000'000;
constexpr std::size_t mebibyte = 1 << 20;  // limits.body_bytes

std::string bytes_of_hex(const std::string& hex) {
  std::string bytes;
  for (std::size_t i = 0; i < hex.size(); i += 2)
    bytes += static_cast<char>(std::stoi(hex.substr(i, 2), nullptr, 16));
  return bytes;
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
  const std::filesystem::path file = in_repository("tests/api/malformed.jsonl");
  std::ifstream stream(file);
  std::vector<MalformedBody> bodies;
  for (std::string line; std::getline(stream, line);) {
    const auto entry = nlohmann::json::parse(line);
    const int status = entry.at("status");
    const bool several = entry.value("several_faults", false);
    bodies.push_back(
        {entry.at("name").get<std::string>(),
         entry.contains("hex") ? bytes_of_hex(entry["hex"]) : entry.at("body").get<std::string>(),
         status, entry.value("pointer", ""), status == 422 && !several, several});
  }
  if (bodies.empty()) throw std::runtime_error("cannot read " + file.string());
  add_generated(bodies);
  return bodies;
}

}  // namespace translucube::test

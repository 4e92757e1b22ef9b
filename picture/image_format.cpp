#include "picture/image_format.h"

#include <algorithm>
#include <cctype>
#include <vector>

namespace translucube {
namespace {

std::string joined(const std::vector<std::string_view>& items, std::string_view last_joint) {
  std::string text;
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (i > 0) text += i + 1 == items.size() ? last_joint : ", ";
    text += items[i];
  }
  return text;
}

}  // namespace

std::optional<ImageFormat> format_named(std::string_view name) {
  for (const ImageFormatRow& row : image_formats)
    if (row.name == name) return row.format;
  return std::nullopt;
}

std::optional<ImageFormat> format_of(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  if (extension.empty()) return std::nullopt;
  std::ranges::transform(extension, extension.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const ImageFormatRow& row : image_formats)
    if (extension == row.extension || extension == row.other_extension) return row.format;
  return std::nullopt;
}

std::string list_formats(std::string_view ImageFormatRow::*column, std::string_view joint) {
  std::vector<std::string_view> items;
  for (const ImageFormatRow& row : image_formats) items.push_back(row.*column);
  return joined(items, joint);
}

std::string list_display_formats(std::string_view ImageFormatRow::*column, std::string_view joint) {
  std::vector<std::string_view> items;
  for (const ImageFormatRow& row : image_formats)
    if (!row.scene_linear) items.push_back(row.*column);
  return joined(items, joint);
}

}  // namespace translucube

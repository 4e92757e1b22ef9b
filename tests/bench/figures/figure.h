#pragma once

// A figure of docs/figures: what config/figures/index.json says of it, and its pictures.

#include <filesystem>
#include <string>
#include <vector>

#include "api/request/catalog.h"
#include "picture/image.h"
#include "picture/sheet/sheet_layout.h"

namespace translucube::figures {

enum class Layout { sheet, cube };

struct Figure {
  std::string name, title, caption, see;
  std::string request;  ///< the file's name in config/figures: a sweep's, or a render's
  Layout layout = Layout::sheet;
  int cell_size = 192;  ///< pixels
  /// Columns, rows and layers; those that the figure has not have one empty label.
  std::array<SheetAxis, 3> axes;
};

/// The picture at [column, row, layer].
struct Picture {
  std::array<int, 3> place;
  Image image;
};

struct Pictures {
  std::vector<Picture> list;
  std::string request;  ///< as the figure's files have it
};

struct Rendering {
  const std::filesystem::path& folder;  ///< of the index and its requests
  const api::Catalog& catalog;
  int threads = 0;
  std::uint32_t samples = 0;  ///< for a quick look; 0: what the requests say
};

/// Every figure of the index, in its order.
std::vector<Figure> load_figures(const std::filesystem::path& folder);

/// Renders the figure: a sweep's points, or the request once for each column and row with their
/// merge patches (RFC 7396) applied. Throws what refuses it.
Pictures render_figure(const Figure& figure, const Rendering& how);

}  // namespace translucube::figures

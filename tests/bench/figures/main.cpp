// Renders the figures of config/figures into docs/figures, with a page of their captions.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <fstream>

#include "picture/color.h"
#include "picture/image_io.h"
#include "picture/sheet/contact_sheet.h"
#include "tests/bench/figures/cube.h"
#include "tests/bench/figures/document.h"
#include "tests/bench/figures/figure.h"

namespace {

using namespace translucube;
using namespace translucube::figures;
namespace fs = std::filesystem;

struct Options {
  fs::path config = "config/service.json", figures = "config/figures", out = "docs/figures";
  std::vector<std::string> only;
  int threads = 0;
  std::uint32_t samples = 0;
};

Image draw_sheet(const Figure& figure, const Pictures& pictures, const SheetLook& look,
                 const Font& font) {
  SheetSpec spec;
  std::ranges::copy(figure.axes, spec.axes.begin());
  spec.axes[3].labels = {""};
  spec.picture_width = pictures.list.at(0).image.width;
  spec.picture_height = pictures.list.at(0).image.height;
  spec.cell_size = figure.cell_size;
  ContactSheet sheet(lay_out_sheet(spec, font), font, look);
  for (const auto& [place, image] : pictures.list)
    sheet.place({place[0], place[1], place[2], 0}, image);
  return sheet.image();
}

void render_all(const Options& options) {
  api::Catalog catalog = api::load_catalog(options.config);
  const ColorConfig colors(catalog.display_config);
  const Display& display = colors.displays().at(0);
  const SheetLook look = display_look(colors, display.name, display.views.at(0));
  const Font font = find_font();
  const std::vector<Figure> figures = load_figures(options.figures);
  for (const std::string& name : options.only)
    if (std::ranges::find(figures, name, &Figure::name) == figures.end())
      throw std::runtime_error("no figure " + name);
  fs::create_directories(options.out);
  for (const Figure& figure : figures) {
    if (!options.only.empty() && !std::ranges::count(options.only, figure.name)) continue;
    std::printf("%s\n", figure.name.c_str());
    std::fflush(stdout);
    const Pictures pictures =
        render_figure(figure, {options.figures, catalog, options.threads, options.samples});
    const Image image = figure.layout == Layout::cube ? draw_cube(figure, pictures, look, font)
                                                      : draw_sheet(figure, pictures, look, font);
    write_image(options.out / (figure.name + ".png"), image, ImageFormat::png,
                {pictures.request, display.name + '/' + display.views.at(0), 8});
  }
  std::ofstream(options.out / "README.md") << document(figures);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Renders the figures of the paper and writes their page."};
  Options options;
  app.add_option("--config", options.config, "service.json")->capture_default_str();
  app.add_option("--figures", options.figures, "folder of index.json")->capture_default_str();
  app.add_option("--out", options.out, "folder of the pictures")->capture_default_str();
  app.add_option("--only", options.only, "names of figures; all if left out");
  app.add_option("--samples", options.samples, "a pixel, for a quick look; 0: as the requests say");
  app.add_option("--threads", options.threads, "0: all cores");
  CLI11_PARSE(app, argc, argv);
  try {
    render_all(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}

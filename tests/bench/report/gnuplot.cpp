#include "tests/bench/report/gnuplot.h"

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <stdexcept>

#include "tests/bench/report/text.h"

namespace translucube::bench {
namespace {

void require_gnuplot() {
  if (std::system("command -v gnuplot >/dev/null") != 0)
    throw std::runtime_error(
        "plots need gnuplot: bash .ci/install_packages.sh .ci/docs_packages.txt");
}

void draw(const Drawing& drawing, const std::filesystem::path& file) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> pipe(popen("gnuplot", "w"), pclose);
  const std::string all =
      text("set terminal svg size %d,%d font 'sans-serif,13' background rgb 'white'\n",
           drawing.width, drawing.height) +
      "set output '" + file.string() +
      "'\nset border 3 lc '#444444'\nset key outside bottom center horizontal\nset bmargin 6\nset "
      "tics nomirror\n"
      "set grid lc '#dddddd'\n" +
      drawing.script + "\n";
  if (!pipe || std::fputs(all.c_str(), pipe.get()) < 0 || std::fflush(pipe.get()) != 0)
    throw std::runtime_error("cannot run gnuplot");
}

}  // namespace

double abscissa(const std::string& row) {
  return std::strtod(row.c_str() + row.find_last_of(' ') + 1, nullptr);
}

std::string data_block(const std::string& name, const std::string& lines) {
  return "$" + name + " << EOD\n" + lines + "EOD\n";
}

void draw(const std::vector<Drawing>& drawings, const std::filesystem::path& folder) {
  require_gnuplot();
  std::filesystem::create_directories(folder);
  for (const Drawing& drawing : drawings) draw(drawing, folder / (drawing.id + ".svg"));
}

}  // namespace translucube::bench

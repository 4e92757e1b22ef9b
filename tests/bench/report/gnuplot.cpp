#include "tests/bench/report/gnuplot.h"

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <stdexcept>

#include "tests/bench/report/text.h"

namespace translucube::bench {

void require_gnuplot() {
  if (std::system("command -v gnuplot >/dev/null") != 0)
    throw std::runtime_error(
        "plots need gnuplot: bash .ci/install_packages.sh .ci/docs_packages.txt");
}

void draw(const std::string& script, const std::filesystem::path& file, int width, int height) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> pipe(popen("gnuplot", "w"), pclose);
  const std::string all =
      text("set terminal svg size %d,%d font 'sans-serif,13' background rgb 'white'\n", width,
           height) +
      "set output '" + file.string() +
      "'\nset border 3 lc '#444444'\nset key outside bottom center horizontal\nset bmargin 6\nset "
      "tics nomirror\n"
      "set grid lc '#dddddd'\n" +
      script + "\n";
  if (!pipe || std::fputs(all.c_str(), pipe.get()) < 0 || std::fflush(pipe.get()) != 0)
    throw std::runtime_error("cannot run gnuplot");
}

}  // namespace translucube::bench

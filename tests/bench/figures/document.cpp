#include "tests/bench/figures/document.h"

namespace translucube::figures {

std::string document(const std::vector<Figure>& figures) {
  std::string text =
      "# Figures\n\n"
      "The figures of Gerardin et al. 2019, \"A translucency classification for computer "
      "graphics\", and the\nexperiments that the paper describes in words. "
      "`build/release/bin/figures` renders all of them and writes\nthis page; `--only NAME` "
      "renders one. Each request is in the public format: a sweep's can be posted to\n"
      "`/v1/sweeps`, the others to `/v1/renders`; what a figure changes from picture to picture "
      "is in\n[config/figures/index.json](../../config/figures/index.json), as merge patches.\n";
  for (const Figure& figure : figures)
    text += "\n## " + figure.title + "\n\n![" + figure.title + "](" + figure.name + ".png)\n\n" +
            figure.caption + "\n\n**What to see:** " + figure.see + "\n\nRequest: [" +
            figure.request + "](../../config/figures/" + figure.request + ")\n";
  return text;
}

}  // namespace translucube::figures

#pragma once

// Why targets are missed, written by people after a look at the figures; docs/speed.md tells it
// beside the figure.

#include <string>

namespace translucube::speed {

struct Reason {
  const char* figure;  ///< "table, row, quantity" or "table, row" or "table"
  const char* why;
};
inline constexpr Reason reasons[] = {
    {"materials, A2",
     "Two dimensions decide, and the points are drawn anew for each pass, so that the error can be "
     "told: one pass of all 64 samples has a sixth of the error."},
    {"materials, R05",
     "What of the error comes from where (R10, relMSE x samples .87 in all): .01 is the surface's "
     "reflection; .21 the first way out, nearly all of it the exit's own noise given the way "
     "(lights .05, the drawn ray .15), as the exact expectation of the exit along the same ways "
     "has .005; .66 the later ways out, .45 of it which way they take inside and the rest again "
     "exits (R05: .61, .18 first, .25 ways; R50: .80, .10 first, .54 ways). So a control variate "
     "of the first way through a prefiltered environment changed nothing (tried, taken out), and "
     "two levels of paths, cheap ones with expected exits and dear ones for the difference, gain "
     "less than they cost while the exits are as noisy: both need to fall. Lights drawn in the "
     "exit's lobe from a prefiltered map, with the rest of the lobe by its drawn ray, are what is "
     "left to try."},
    {"materials, R10", "As R05."},
    {"materials, R25", "As R05."},
    {"materials, R50", "As R05."},
    {"lanes",
     "A lane costs what it did, four exp() for each contribution; the trace of S10 that it is held "
     "against takes half of what it took when a lane was within the 5 %."},
    {"cores",
     "On this shared machine the ratio wavers between runs and materials; 1.7 to 2.2 were seen. "
     "Passes end with the slowest tile, and what lies between passes has one thread."},
    {"memory",
     "Tiles in work, the light lists and the tables of the environment do not grow with the image: "
     "at 4096 x 4096 the film is all there is."},
    {"meshes, white",
     "A ray in a mesh costs 170 to 500 ns in Embree (two cache misses deep), a knot takes 13 of "
     "them for each camera sample, and its walk goes path by path, while the sphere's goes in SIMD "
     "and has become twice as fast: packets of rays for many walks at a time are what is next."},
    {"meshes, forest", "As in the white furnace: the rays."},
    {"service",
     "Four samples of 256 x 256 pixels on two cores allow 610 ns a sample for everything; "
     "scattering bodies take 1100 to 1800, rough ones 600. What is not the trace: two syncs of the "
     "job's record and two of the picture, which were promised, and small work."},
    {"process",
     "80 to 100 ms of work, most of it the environment's file and its tables; the rest is waiting "
     "for the disk and for other processes."},
    {"stopping",
     "Pixels that rare light reaches are told too late; the worst are rough bodies at few "
     "samples."},
    {"sun, S01",
     "Sunlight that the body focuses inside, met by the few places where a thin medium scatters: "
     "connections next to a caustic are rare and bright. Places drawn towards the caustic would "
     "help."},
    {"sun, S1", "As S01."},
};

/// The most specific reason for a missed figure; empty where nobody has written one.
inline std::string reason_for(const std::string& name) {
  std::string why;
  std::size_t longest = 0;
  for (const Reason& reason : reasons) {
    const std::string figure = reason.figure;
    const bool covers = name == figure || name.starts_with(figure + ", ");
    if (!figure.empty() && covers && figure.size() > longest) {
      longest = figure.size();
      why = reason.why;
    }
  }
  return why;
}

}  // namespace translucube::speed

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
     "Of the relMSE of 64 samples (.0096 at R05, .012 at R50) perfect choice of lights, all 512 at "
     "every collision, takes off no more than 18 to 29 %; the balance heuristic is the best of "
     "those "
     "tried, one long pass gains 3 to 7 %. What is left is the way itself, from facet to facet "
     "through the body: with K ways for each camera sample the error falls almost as 1/K, and the "
     "time grows with K. Cheaper ways, or exits shared by neighbouring pixels, are what is left to "
     "try."},
    {"materials, R10", "As R05."},
    {"materials, R25", "As R05."},
    {"materials, R50", "As R05."},
    {"materials, S01",
     "At the target: from .0053 to .0064 between runs, with the machine's speed."},
    {"materials, S1",
     "Far ways out (a fifth of the time is spent solving for them) and the noise of the place "
     "where "
     "the walk leaves; two walks share a camera sample already."},
    {"materials, C",
     "What the walk carries is itself noise where light is absorbed; the connections are at the "
     "limit that 8 or 32 lights a vertex would reach within 20 %."},
    {"materials, M", "Not taken apart yet; near the target."},
    {"cores",
     "On this shared machine the ratio wavers between runs and materials; 1.7 to 2.2 were seen. "
     "Passes end with the slowest tile, and what lies between passes has one thread."},
    {"memory",
     "Tiles in work, the light lists and the tables of the environment do not grow with the image: "
     "at 4096 x 4096 the film is all there is."},
    {"meshes, white",
     "A ray in a mesh costs 170 to 500 ns in Embree (two cache misses deep); a knot takes 13 of "
     "them "
     "for each camera sample, and the sphere's whole sample takes 1000 ns."},
    {"meshes, forest", "As in the white furnace: the rays."},
    {"service",
     "Four samples of 256 x 256 pixels on two cores allow 610 ns a sample for everything; "
     "scattering "
     "bodies take 2000. The walk is not in SIMD yet. What is not the trace: two syncs of the job's "
     "record and two of the picture, which were promised, and small work."},
    {"process",
     "40 ms of work, half of it the environment's file and its tables; the rest is waiting for the "
     "disk and for other processes."},
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

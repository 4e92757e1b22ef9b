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
     "A sample costs about 450 ns, of which the microfacets in SIMD take a fifth: the rest is "
     "environment look-ups and paths that are moved one by one. Of the variance two thirds are at "
     "the "
     "exit and a third at the entry; a light list of any length, or 16 lights in place of 8, takes "
     "off "
     "less than it costs. What is left to try: lights drawn for each lobe, and one path's exits "
     "reused by its neighbours."},
    {"materials, R10", "As R05."},
    {"materials, R25", "As R05; splitting every exit in two gains 10 %."},
    {"materials, R50", "As R05; splitting every exit in two gains 15 %."},
    {"materials, S1",
     "Far ways out (a fifth of the time is spent solving for them) and the noise of the place "
     "where "
     "the walk leaves; two walks share a camera sample already."},
    {"materials, C",
     "What the walk carries is itself noise where light is absorbed; the connections are at the "
     "limit that 8 or 32 lights a vertex would reach within 20 %."},
    {"meshes, white",
     "A ray in a mesh costs 170 to 500 ns in Embree (two cache misses deep); a knot takes 13 of "
     "them "
     "for each camera sample, and the sphere's whole sample takes 1000 ns."},
    {"meshes, forest", "As in the white furnace: the rays."},
    {"service",
     "Four samples of 256 x 256 pixels on two cores allow 610 ns a sample for everything; "
     "scattering "
     "bodies take 2000. The walk is not in SIMD yet. What is not the trace: two syncs of the job's "
     "record and two of the picture, which were promised, and 5 ms of work."},
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

#pragma once

#include <string>

namespace translucube::speed {

/// The ceilings that tests/transport/efficiency_test.cpp holds the renderer to, as JSON text:
/// measured now, with room for chance.
std::string guard();

}  // namespace translucube::speed

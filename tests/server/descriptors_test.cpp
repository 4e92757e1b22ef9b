#include "server/base/descriptors.h"

#include <gmock/gmock.h>

#include <stdexcept>

#include "server/base/server_config.h"

namespace translucube::server::test {
namespace {

TEST(DescriptorsTest, WhatIsConfiguredStaysWhereThereIsRoom) {
  ServerConfig config;
  fit_descriptors(config, 4096);
  EXPECT_EQ(config.connections, ServerConfig().connections);
  EXPECT_EQ(config.open_pictures, ServerConfig().open_pictures);
}

TEST(DescriptorsTest, ConnectionsAndPicturesFitIntoWhatThereIs) {
  for (const std::size_t limit : {128, 200, 256, 400, 700, 1024}) {
    ServerConfig config;
    fit_descriptors(config, limit);
    EXPECT_GE(config.connections, 8) << limit;
    EXPECT_GE(config.open_pictures, 1) << limit;
    EXPECT_LE(static_cast<std::size_t>(config.connections + config.open_pictures +
                                       config.http_threads + config.transfers),
              limit);
  }
}

TEST(DescriptorsTest, TooFewToServeAreSaidAtTheStart) {
  ServerConfig config;
  EXPECT_THROW(fit_descriptors(config, 64), std::runtime_error);
}

}  // namespace
}  // namespace translucube::server::test

#pragma once

#include <filesystem>

#include "server/store/sqlite/connection.h"

namespace translucube::server {

/// Sets the connection up for durable work (WAL, an fsync for each commit), creates the tables of a
/// new store and checks those of an old one. Throws StoreError for a corrupt or newer store.
void prepare_schema(sql::Connection& writer, const std::filesystem::path& file);

}  // namespace translucube::server

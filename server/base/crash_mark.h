#pragma once

#include <filesystem>

namespace translucube::server {

/// From here on, a process that ends by a fault of its own (SIGSEGV, SIGBUS, SIGILL, SIGFPE,
/// SIGABRT) leaves this file behind; one that is killed from outside does not. Other handlers of
/// these signals run as before.
void mark_crashes(const std::filesystem::path& file);

/// True if the file was left behind, which is removed.
bool take_crash_mark(const std::filesystem::path& file);

}  // namespace translucube::server

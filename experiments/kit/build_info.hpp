#pragma once

namespace qddot::inline kit::build_info {

// Filled in by build_info.cmake at build time.
extern const char* const version;      // git describe, or the project's version
extern const char* const source_hash;  // SHA-256 of src, integrators and experiments
extern const char* const compiler;
extern const char* const flags;

}  // namespace qddot::inline kit::build_info

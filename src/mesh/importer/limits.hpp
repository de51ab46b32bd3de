#pragma once

#include <cstddef>

namespace crashrank::importer {

/// Puts this process under its limits: memory, processor time, no new files, no core dump, no
/// descriptors but the standard streams and a few, an end with its parent. False where the system
/// refuses one of them.
bool confine(std::size_t memory_bytes, double seconds);

}  // namespace crashrank::importer

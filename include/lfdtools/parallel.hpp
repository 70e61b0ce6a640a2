// Work spread over threads, with results that do not depend on their number.
#pragma once

#include <cstddef>
#include <functional>

namespace lfd {

/// Calls task(i) for every i in [0, count), on up to `jobs` threads. Each task writes only its own result, so the
/// outcome is the same for every `jobs`. The exception of the lowest i that throws is thrown again after all tasks have
/// ended.
/// @param jobs  0: one a processor
void parallel_for(std::size_t count, unsigned jobs, const std::function<void(std::size_t)>& task);

}  // namespace lfd

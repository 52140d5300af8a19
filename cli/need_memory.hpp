#pragma once
#include <cstddef>
#include <string>

namespace limcycle {

/// Rejects (InputError) a request that would not fit into memory, before anything is allocated or computed: `things`
/// objects of `bytes` each, a lower estimate. `key`: the flag or key that requests them; `remedy`: advice.
void need_memory(const std::string& key, double things, double bytes, const std::string& remedy);

}  // namespace limcycle

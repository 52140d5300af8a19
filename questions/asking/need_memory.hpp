#pragma once
#include <string>

namespace limcycle {

/// Documents of a result that will be in memory beside it, whole.
struct HeldDocuments {
  bool json = false, csv = false;
};

/// Rejects (InputError) a request that would not fit into memory, before anything is allocated or computed: `things`
/// objects of `bytes` each, a lower estimate. `key`: the argument or key that requests them; `remedy`: advice.
void need_memory(const std::string& key, double things, double bytes, const std::string& remedy);

}  // namespace limcycle

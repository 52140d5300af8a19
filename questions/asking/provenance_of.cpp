#include "limcycle/questions/asking/provenance_of.hpp"

#include <algorithm>
#include <thread>

#include "build_info.hpp"
#include "limcycle/analysis/lanes/isa.hpp"

namespace limcycle {

Provenance provenance_of(std::uint64_t seed, int threads, const Case* from) {
  Provenance made;
  made.version = build_info::version;
  made.commit = build_info::commit;
  made.compiler = build_info::compiler;
  made.build_type = build_info::build_type;
  made.isa = to_string(Isa::scalar);
  made.seed = seed;
  // Threads of the machine, even if mpirun gives this process a part of it: results have the same bytes either way.
  made.threads = threads > 0 ? threads : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  if (from != nullptr) {
    made.title = from->title;
    made.file = from->file;
    made.sha256 = from->sha256;
    made.overrides = from->overrides;
    made.curves = from->curves;
    made.matrices = from->matrices;
    if (from->loop) made.measured = measured_plants(*from->loop);
  }
  return made;
}

}  // namespace limcycle

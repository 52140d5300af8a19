#include "limcycle/cli/asking_of.hpp"

#include "limcycle/cli/interrupt.hpp"

namespace limcycle {

Asking asking_of(const CommonFlags& flags, Progress& bar) {
  catch_interrupts();
  return {.seed = flags.seed,
          .threads = flags.threads,
          .isa = instruction_set(flags),
          .stop = interrupted,
          .progress = [&bar](double fraction, std::string_view what) { bar.show(fraction, what); }};
}

}  // namespace limcycle

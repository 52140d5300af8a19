#include "limcycle/questions/asking/words.hpp"

#include <cctype>

#include "limcycle/models/measured/plants_of_loop.hpp"
#include "limcycle/reports/format/number.hpp"
#include "limcycle/reports/format/table.hpp"

namespace limcycle {

std::string cause_in_words(double time_limit) {
  return time_limit > 0.0 ? "time limit of " + shortest(time_limit) + " s reached" : "interrupted";
}

std::string first_line(Status status, std::string cause) {
  if (status != Status::interrupted) return {};
  cause.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(cause.front())));
  return cause + ": this result is incomplete.\n\n";
}

std::string basis_lines(const Case& from) {
  std::string lines;
  if (from.loop)
    for (const MeasuredPlantAt& plant : measured_plants(*from.loop))
      lines += '\n' + wrapped(basis_in_words(plant) + '.');
  return lines;
}

}  // namespace limcycle

#include "limcycle/cli/command.hpp"

namespace limcycle {

// One file each in commands/. A new one is its file and its name here, twice.
Command new_command(), check_command(), laws_command(), predict_command(), report_command(), simulate_command(),
    df_command(), margin_command(), remedy_command(), tune_command(), continue_command(), map_command(),
    sensitivity_command(), status_command(), identify_command(), synthesize_command(), precision_command(),
    adequate_command(), dissipativity_command(), claims_command(), experiment_command(), manual_command(),
    completion_command();

const std::vector<Command>& commands() {
  static const std::vector<Command> all{
      new_command(),        check_command(),     laws_command(),        predict_command(),       report_command(),
      simulate_command(),   df_command(),        margin_command(),      remedy_command(),        tune_command(),
      continue_command(),   map_command(),       sensitivity_command(), status_command(),        identify_command(),
      synthesize_command(), precision_command(), adequate_command(),    dissipativity_command(), claims_command(),
      experiment_command(), manual_command(),    completion_command()};
  return all;
}

}  // namespace limcycle

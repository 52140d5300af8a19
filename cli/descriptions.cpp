#include <algorithm>
#include <stdexcept>

#include "limcycle/cli/description.hpp"

namespace limcycle {
namespace {

constexpr auto* begin_group = "To begin";
constexpr auto* hunt_group = "Does it hunt?";
constexpr auto* change_group = "What if a number changes?";
constexpr auto* trust_group = "Which law, which method is enough?";
constexpr auto* evidence_group = "What do the numbers rest on?";
constexpr auto* install_group = "For installers";

std::vector<Description> to_begin() {
  return {
      {"new",
       begin_group,
       "Writes a case file that works at once, for the plant, the controller and the friction law or element that you "
       "name. Every key stands in it with its unit, its meaning and its default, the optional ones as comments. Put "
       "your own numbers in place of those that are there.\n"
       "Without options it is a mass under PID control with LuGre friction. With --element and without --friction the "
       "loop has that element in place of friction. A file that exists is left alone, but for --force.",
       {{"limcycle new -o servo.toml", "the default: mass, PID, LuGre friction"},
        {"limcycle new --plant two-mass --friction coulomb -o drive.toml", "a drive with an elastic shaft"},
        {"limcycle new --plant zpk --controller none --element relay", "a relay before a plant, to look at"}}},
      {"check",
       begin_group,
       "Reads a case file, checks every key and every rule between them, and tells what the loop is made of: its "
       "elements, its states, whether it is stable without its elements, and where roots are searched. What is wrong "
       "is told with file, line, key, value and what would be right.",
       {{"limcycle check cases/pid-lugre.toml", "what this case holds"},
        {"limcycle check cases/pid-lugre.toml --set loop.controller.kd=12.0", "the same with another gain"}}},
      {"laws",
       begin_group,
       "Lists the friction laws, elements, plants and controllers that a case may name. With KIND it tells all about "
       "that one: equation, states, memory, drift, passivity, source, and every parameter with unit, default and "
       "valid range.",
       {{"limcycle laws", "all of them"}, {"limcycle laws lugre", "one in full"}}},
  };
}

std::vector<Description> does_it_hunt() {
  return {
      {"predict",
       hunt_group,
       "Searches limit cycles by describing function, by the composite describing function (mass and friction as one "
       "element) and by harmonic balance; simulates the loop from several states; finds each cycle that is really "
       "there by shooting and judges its stability by its Floquet multipliers. Each prediction gets a verdict: "
       "confirmed (within 5 % of a cycle), biased, false or undecided; cycles that a method did not see are listed "
       "as missed.\n"
       "[search] says where roots are searched, [predict] which methods, how many starts and how accurate.",
       {{"limcycle predict cases/pid-lugre.toml", "the answer as text"},
        {"limcycle predict cases/pid-lugre.toml -o servo.html", "and as one page with figures"},
        {"limcycle predict cases/tutorial-servo.toml --set loop.friction.Fs=9.0 --verbose",
         "another break-away force, and what each method did"},
        {"limcycle predict cases/relay-integrator.toml --require-agreement --json result.json",
         "for a script: exit code 1 if a method is wrong"}}},
      {"report",
       hunt_group,
       "Writes one page that needs no network: the answer, the loop as a block diagram, every figure, the verdict on "
       "every method, sensitivity, energy, work against precision, provenance and the case file itself, so that the "
       "page alone makes the result again.",
       {{"limcycle report cases/relay-integrator.toml --quick -o relay.html", "without the slow parts"}}},
      {"simulate",
       hunt_group,
       "Integrates the loop in time from the state and with the signals of [simulate], checks the run by a second one "
       "at other tolerances, and counts where the energy goes. The samples go to the file of --csv (or -o), the "
       "summary to stdout.",
       {{"limcycle simulate cases/pid-lugre.toml -o run.csv", "time, state, input and force as columns"}}},
      {"df",
       hunt_group,
       "Tabulates the describing function of the case's element over the amplitudes, frequencies and biases of [df], "
       "each value with an estimate of its error.",
       {{"limcycle df cases/df-lugre.toml --set df.frequency=[1.0] --csv df.csv", "one frequency, as a table"}}},
  };
}

std::vector<Description> what_if() {
  return {
      {"margin",
       change_group,
       "Changes each number of the case alone, up and down by a factor, until hunting begins or ends, and tells how "
       "far that is. The end of a cycle is found to the fold itself.",
       {{"limcycle margin cases/relay-third-order.toml", "every number that is not zero"},
        {"limcycle margin cases/tutorial-servo.toml --parameter loop.friction.Fs --factor 3", "one number only"}}},
      {"continue",
       change_group,
       "Follows the limit cycles, stable and unstable, over a range of one number, round folds, to where they end. "
       "It tells the folds, the changes of stability and the ends, each with an error.",
       {{"limcycle continue cases/relay-third-order.toml --parameter loop.element.dead_zone=0.05:0.1",
         "to the fold at which the oscillation ends"}}},
      {"map",
       change_group,
       "Asks at every point of a plane of two numbers what the loop does and whether each method sees it. With "
       "--store every point is kept in a file as soon as it is known: Ctrl-C costs nothing, --resume goes on, and "
       "under mpirun many machines share the work.",
       {{"limcycle map cases/relay-third-order.toml --x loop.element.dead_zone=0.05:0.1:5 "
         "--y loop.element.level=0.5:2:4 --store plane.db",
         "20 points, kept in a store"},
        {"limcycle map cases/relay-third-order.toml --x loop.element.dead_zone=0.05:0.1:5 "
         "--y loop.element.level=0.5:2:4 --store plane.db --resume -o plane.svg",
         "go on with it, and draw it"}}},
      {"sensitivity",
       change_group,
       "Tells how period and amplitude of the cycle move with every number: derivatives, changes one at a time, and "
       "over the whole spread of [sensitivity] Morris and Sobol indices and the share of loops that hunt. Without "
       "that section every number is spread evenly by 20 % to both sides.",
       {{"limcycle sensitivity cases/relay-third-order.toml --local", "derivatives and one at a time only"},
        {"limcycle sensitivity cases/relay-integrator.toml --samples 16 --trajectories 4",
         "a quick look at the rest"}}},
      {"status",
       change_group,
       "Tells how far a sweep with --store has got, how fast it is, and what is known so far; also while it runs.",
       {{"limcycle status plane.db", "of the store that `map` or `sensitivity` wrote"}}},
  };
}

std::vector<Description> enough() {
  return {
      {"precision",
       trust_group,
       "Measures every method on this case: how long it takes for how much accuracy, against a verified reference. "
       "With --stability it shows instead where time steppers fail, over stiffness and tolerance.",
       {{"limcycle precision cases/relay-integrator.toml --no-stiffness", "methods for the cycle and its element"}}},
      {"adequate",
       trust_group,
       "Replaces the friction law by lesser ones fitted to it, and each method by cheaper ones, and tells the least "
       "law and the cheapest method whose answer stays within a tolerance.",
       {{"limcycle adequate cases/belt-coulomb.toml --spread 0 --tolerance 0.05", "for these numbers exactly"}}},
      {"dissipativity",
       trust_group,
       "Asks of the law (not of the loop) whether its state and force stay bounded, whether it is passive, how much "
       "energy can be had from it, and from which viscous friction on it is passive. A law that is not gets a "
       "counter-example: a motion that has energy from it.",
       {{"limcycle dissipativity cases/pid-lugre.toml", "of the friction of this case"}}},
  };
}

std::vector<Description> evidence() {
  return {
      {"claims",
       evidence_group,
       "Holds analytic statements about describing functions, laws and cycles against the numbers of this program: "
       "each gets a verdict, with a counter-example where it fails. A case may hold claims of its own ([[claim]]). "
       "The exit code is 1 if a verdict is not the one expected.",
       {{"limcycle claims --list", "what is claimed"},
        {"limcycle claims A1 --verbose", "one claim, with every comparison"},
        {"limcycle claims cases/relay-claims.toml", "the claims of a case"}}},
      {"experiment",
       evidence_group,
       "Runs the experiments of the documents that this program is built on, for all friction laws side by side. "
       "Without NAME they are listed; `all` runs all of them.",
       {{"limcycle experiment", "the list"},
        {"limcycle experiment pre-sliding --law lugre --law dahl -o loops.svg", "one, for two laws, as a picture"}}},
  };
}

std::vector<Description> for_installers() {
  return {
      {"manual",
       install_group,
       "Prints a manual page in roff: that of limcycle, of one of its commands, or with `case` that of the format of "
       "case files.",
       {{"limcycle manual > limcycle.1", "of the program"},
        {"limcycle manual predict > limcycle-predict.1", "of a command"},
        {"limcycle manual case > limcycle-case.5", "of case files"}}},
      {"completion",
       install_group,
       "Prints a script that lets the shell complete commands, options, names and files.",
       {{"limcycle completion bash > limcycle.bash", "then: source limcycle.bash, in ~/.bashrc"},
        {"limcycle completion zsh > _limcycle", "into a folder of $fpath"},
        {"limcycle completion fish > limcycle.fish", "into ~/.config/fish/completions"}}},
  };
}

}  // namespace

const std::vector<Description>& descriptions() {
  static const std::vector<Description> all = [] {
    std::vector<Description> list;
    for (const auto part : {to_begin, does_it_hunt, what_if, enough, evidence, for_installers})
      std::ranges::move(part(), std::back_inserter(list));
    return list;
  }();
  return all;
}

const Description& description_of(std::string_view name) {
  const auto found = std::ranges::find(descriptions(), name, &Description::name);
  if (found == descriptions().end()) throw std::logic_error("no description of " + std::string(name));
  return *found;
}

}  // namespace limcycle

#include <algorithm>
#include <stdexcept>

#include "limcycle/cli/help/description.hpp"

namespace limcycle {
namespace {

constexpr auto* begin_group = "Getting started";
constexpr auto* hunt_group = "Prediction and simulation";
constexpr auto* change_group = "Parameter studies";
constexpr auto* trust_group = "Choice of law and method";
constexpr auto* evidence_group = "Verification";
constexpr auto* install_group = "Installation";

std::vector<Description> to_begin() {
  return {
      {"new",
       begin_group,
       "Writes a complete, valid case file for the plant, the controller and the friction law or element that you "
       "name. It lists every key with its unit, meaning and default; optional keys are commented out. Replace the "
       "numbers by your own.\n"
       "Without options the case is a mass under PID control with LuGre friction. With --element and without "
       "--friction, the loop has that element in place of friction. An existing file is not overwritten without "
       "--force.",
       {{"limcycle new -o servo.toml", "the default: mass, PID, LuGre friction"},
        {"limcycle new --plant two-mass --friction coulomb -o drive.toml", "a drive with an elastic shaft"},
        {"limcycle new --plant zpk --controller none --element relay", "a relay before a plant, printed only"}}},
      {"check",
       begin_group,
       "Reads a case file, checks every key and every rule between them, and prints a summary of the loop: its "
       "elements, its states, its stability without the elements, and the search box. Of a plant that is known by "
       "measured data it states what they cover, and the order and the error of their fit; --fit draws both. An error "
       "names the file, line, key and value, and what is allowed.",
       {{"limcycle check cases/pid-lugre.toml", "summary of this case"},
        {"limcycle check cases/measured-axis.toml --fit fit.svg", "the same, and a picture of data and fit"},
        {"limcycle check cases/pid-lugre.toml --set loop.controller.kd=12.0", "the same with a different gain"}}},
      {"laws",
       begin_group,
       "Lists the friction laws, elements, plants and controllers that a case may name. With KIND it describes that "
       "one: equation, states, memory, drift, passivity, source, and every parameter with unit, default and valid "
       "range.",
       {{"limcycle laws", "all of them"}, {"limcycle laws lugre", "one in full"}}},
  };
}

std::vector<Description> does_it_hunt() {
  return {
      {"predict",
       hunt_group,
       "Searches for limit cycles by describing function, by the composite describing function (mass and friction as "
       "one element) and by harmonic balance. Simulates the loop from several states, verifies each cycle by shooting "
       "and determines its stability from its Floquet multipliers. Each prediction gets a verdict: confirmed (within 5 "
       "% of a cycle), biased, false or undecided; cycles that a method did not find are listed as missed.\n"
       "[search] sets the search box; [predict] sets the methods, the number of starts and the accuracy.",
       {{"limcycle predict cases/pid-lugre.toml", "the answer as text"},
        {"limcycle predict cases/pid-lugre.toml -o servo.html", "and as one page with figures"},
        {"limcycle predict cases/tutorial-servo.toml --set loop.friction.Fs=9.0 --verbose",
         "another break-away force, with the work of each method"},
        {"limcycle predict cases/relay-integrator.toml --require-agreement --json result.json",
         "for a script: exit code 1 if a method is wrong"}}},
      {"report",
       hunt_group,
       "Writes one page that needs no network: the answer, what would end the hunting, a block diagram of the loop, "
       "all "
       "figures, the verdict on every method, sensitivity, energy balance, provenance and the case file itself. The "
       "page "
       "alone suffices to reproduce the result.",
       {{"limcycle report cases/relay-integrator.toml --quick -o relay.html", "without the slow parts"}}},
      {"simulate",
       hunt_group,
       "Integrates the loop in time from the state and with the signals of [simulate], checks the run by a second one "
       "at other tolerances, and computes the energy balance. The samples go to the file of --csv (or -o), the summary "
       "to stdout.",
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
       "Varies each number of the case separately, up and down by a factor, until hunting begins or ends, and prints "
       "the margin; with --toward several numbers together. Where a cycle ends at a fold, the fold itself is located.",
       {{"limcycle margin cases/relay-third-order.toml", "every number that is not 0"},
        {"limcycle margin cases/tutorial-servo.toml --parameter loop.friction.Fs --factor 3", "one number only"},
        {"limcycle margin cases/tutorial-servo.toml --toward kd=300,kp=4000", "how far on the way to other gains"}}},
      {"remedy",
       change_group,
       "Finds why a loop hunts, by taking one feature away at a time, and tries the known remedies: for each the value "
       "nearest to the present at which no start hunts any more, confirmed by predictions on both sides, and what the "
       "loop then costs in error, speed, margins and noise. --apply writes the case with one of them.",
       {{"limcycle remedy cases/belt-squeal.toml --threads 2", "the cause, and all remedies"},
        {"limcycle remedy cases/over-compensated.toml --apply gain-kp -o fixed.toml", "the case with one remedy"}}},
      {"tune",
       change_group,
       "Chooses numbers within bounds so that the loop does not hunt and a cost is least: the peak sensitivity Ms of "
       "the "
       "linear loop, or the settling time or the integral of the squared error of the loop with its friction after a "
       "step. Points that fill the bounds are tried, then searches from the best ones that lie apart. States whether "
       "these agree, and what lies next to the result. A name such as kp stands for the only number with that name. "
       "--apply writes the case with the numbers that were found.",
       {{"limcycle tune cases/pid-lugre.toml --vary kp=1:20,ki=0:5 --minimise ms --threads 2",
         "gains that do not hunt"},
        {"limcycle tune cases/over-compensated.toml --vary kp=1:100 --minimise settling --samples 8 --apply -o "
         "tuned.toml",
         "the fastest, as a case"}}},
      {"continue",
       change_group,
       "Follows the limit cycles, stable and unstable, over a range of one number, around folds and to their ends. It "
       "prints the folds, the changes of stability and the ends, each with an error.",
       {{"limcycle continue cases/relay-third-order.toml --parameter loop.element.dead_zone=0.05:0.1",
         "to the fold at which the oscillation ends"}}},
      {"map",
       change_group,
       "Computes the outcome, and whether each method predicts it, at every point of a grid over two numbers. With "
       "--store every point is saved as soon as it is known: Ctrl-C loses nothing, --resume continues, and under "
       "mpirun many machines share the work. --outcomes simulates from the starts alone and judges no method: it is "
       "faster, but finds no cycle that none of the starts reaches.",
       {{"limcycle map cases/relay-third-order.toml --x loop.element.dead_zone=0.05:0.1:5 "
         "--y loop.element.level=0.5:2:4 --store plane.db",
         "20 points, kept in a store"},
        {"limcycle map cases/relay-third-order.toml --x loop.element.dead_zone=0.05:0.1:5 "
         "--y loop.element.level=0.5:2:4 --store plane.db --resume -o plane.svg",
         "continue it, and draw it"}}},
      {"sensitivity",
       change_group,
       "Computes the sensitivity of the period and amplitude of the cycle to every number: derivatives, changes one at "
       "a time, and, over the spread of [sensitivity], Morris and Sobol indices and the share of loops that hunt. "
       "Without that section every number varies uniformly by +-20 %.",
       {{"limcycle sensitivity cases/relay-third-order.toml --local", "derivatives and one at a time only"},
        {"limcycle sensitivity cases/relay-integrator.toml --samples 16 --trajectories 4",
         "a quick look at the rest"}}},
      {"status",
       change_group,
       "Prints the progress, the speed and the results so far of a sweep with --store, also while it runs.",
       {{"limcycle status plane.db", "of the store that `map` or `sensitivity` wrote"}}},
  };
}

std::vector<Description> enough() {
  return {
      {"identify",
       trust_group,
       "Fits the friction laws of [identify] to measured records: force against steady velocity, sliding with a "
       "varying "
       "velocity, small motions before sliding, break-away, or the free motion of the case's plant. It prints each "
       "number with its 95 % interval, names those "
       "that the records do not determine, and chooses the simplest law that the records support. -o FILE.toml writes "
       "the case with the fitted law, for `predict`, `sensitivity` and `report`; -o FILE.svg draws measured and fitted "
       "forces. --plan shows which further record would narrow which number most.",
       {{"limcycle identify cases/records/servo.toml -o fitted.toml",
         "fit three laws, and write the case with the best"},
        {"limcycle identify cases/records/carriage.toml", "the friction force was not measured, only the motion"},
        {"limcycle identify cases/records/servo.toml -o fit.svg", "measured and fitted forces as a picture"},
        {"limcycle identify cases/records/servo.toml --plan", "and what should be measured next"}}},
      {"synthesize",
       trust_group,
       "Writes records that a rig with the friction law of the case would give, with noise and other faults of "
       "measurement, and a case that `identify` fits to them. As the true numbers are known, it shows what such "
       "records "
       "can determine.",
       {{"limcycle synthesize cases/pid-lugre.toml --noise 0.02 --seed 3 -o rig", "2 % noise of the force"},
        {"limcycle synthesize cases/pid-lugre.toml --free -o free-rig", "free motions of the mass too"}}},
      {"precision",
       trust_group,
       "Measures the accuracy and cost of every method on this case, against a verified reference. With --stability it "
       "shows instead where time steppers fail, over stiffness and tolerance.",
       {{"limcycle precision cases/relay-integrator.toml --no-stiffness", "methods for the cycle and its element"}}},
      {"adequate",
       trust_group,
       "Replaces the friction law by simpler ones fitted to it, and each method by cheaper ones, and prints the "
       "simplest law and the cheapest method whose answer stays within a tolerance.",
       {{"limcycle adequate cases/belt-coulomb.toml --spread 0 --tolerance 0.05", "for these numbers exactly"}}},
      {"dissipativity",
       trust_group,
       "Determines for the law (not the loop) whether its state and force stay bounded, whether it is passive, how "
       "much energy can be extracted, and the least viscous friction that makes it passive. For a law that is not "
       "passive it gives a counter-example: a motion that extracts energy.",
       {{"limcycle dissipativity cases/pid-lugre.toml", "of the friction of this case"}}},
  };
}

std::vector<Description> evidence() {
  return {
      {"claims",
       evidence_group,
       "Compares analytic statements about describing functions, laws and cycles with the numbers of this program: "
       "each gets a verdict, with a counter-example where it fails. A case may hold claims of its own ([[claim]]). The "
       "exit code is 1 if a verdict is not the expected one.",
       {{"limcycle claims --list", "all claims"},
        {"limcycle claims A1 --verbose", "one claim, with every comparison"},
        {"limcycle claims cases/relay-claims.toml", "the claims of a case"}}},
      {"experiment",
       evidence_group,
       "Runs the experiments of the source documents for all friction laws side by side. Without NAME it lists them; "
       "`all` runs all of them.",
       {{"limcycle experiment", "the list"},
        {"limcycle experiment pre-sliding --law lugre --law dahl -o loops.svg", "one, for two laws, as a picture"}}},
  };
}

std::vector<Description> for_installers() {
  return {
      {"manual",
       install_group,
       "Prints a manual page in roff: of limcycle, of one of its commands, or, with `case`, of the case-file format.",
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

#include "limcycle/reports/case_files/check.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "limcycle/cli/command.hpp"
#include "limcycle/cli/output/output.hpp"
#include "limcycle/models/linear/dense.hpp"
#include "limcycle/questions/asking/units_of.hpp"
#include "limcycle/reports/figures/blocks/block_diagram.hpp"
#include "limcycle/reports/figures/fit_picture.hpp"
#include "limcycle/reports/figures/staircase.hpp"

namespace limcycle {
namespace {

/// Poles of the linear part without its elements; none are listed with a delay, which makes them infinitely many.
void describe_poles(const Loop& loop, CheckSummary& summary) {
  summary.order = static_cast<int>(loop.states());
  summary.delay = loop.delay;
  if (loop.delay > 0.0) return;
  if (loop.states() == 0) {
    summary.stable = true;
    return;
  }
  const Eigen::VectorXcd poles = eigenvalues(loop.A);
  summary.slowest_pole = poles.real().maxCoeff();
  // A pole at zero is computed as rounding of the others, a repeated one as the square root of that.
  const double fastest = poles.cwiseAbs().maxCoeff();
  const bool repeated = (poles.array().abs() <= 1e-7 * fastest).count() > 1;
  if (std::abs(*summary.slowest_pole) <= (repeated ? 1e-7 : 1e-12) * fastest) summary.slowest_pole = 0.0;
  summary.stable = *summary.slowest_pole < 0.0;
}

std::string kind_in(const Block& block) {
  if (const auto* element = std::get_if<Element>(&block.what)) return std::string(element->kind());
  if (const auto* plant = std::get_if<Plant>(&block.what)) return std::string(kind_of(*plant));
  if (const auto* controller = std::get_if<Controller>(&block.what)) return std::string(kind_of(*controller));
  return std::string(kind_of(std::get<LinearBlock>(block.what)));
}

std::vector<CheckSummary::Block> blocks_of(const Diagram& diagram) {
  std::vector<CheckSummary::Block> blocks;
  for (const Block& block : diagram.blocks) {
    std::vector<std::string> inputs;
    for (const SignalSum& sum : block.inputs) inputs.push_back(sum_in_words(sum));
    if (!block.on.empty()) inputs.push_back(block.on + (block.against.empty() ? "" : ", " + block.against));
    blocks.push_back({block.name, kind_in(block), std::move(inputs), block.contact != Contact::none});
  }
  return blocks;
}

CheckSummary summary_of(const Case& from) {
  CheckSummary summary;
  if (from.loop) {
    const Loop loop = build_loop(*from.loop);
    if (from.loop->diagram) {
      summary.blocks = blocks_of(*from.loop->diagram);
    } else {
      summary.plant = kind_of(from.loop->plant);
      summary.controller = kind_of(from.loop->controller);
    }
    for (std::size_t i = 0; i < loop.elements.size(); ++i)
      summary.elements.push_back({loop.ports[i].path, std::string(loop.elements[i].kind())});
    summary.states = state_names(loop);
    describe_poles(loop, summary);
    summary.search = from.predict.search ? from.predict.search : default_search_box(loop);
    summary.search_from_case = from.predict.search.has_value();
  } else if (from.element) {
    summary.elements.push_back({from.element_path, std::string(from.element->kind())});
    const int states = from.element->states();
    for (int i = 0; i < states; ++i)
      summary.states.push_back(states == 1 ? std::string("z") : fmt::format("z{}", i + 1));
  }
  if (from.df)
    summary.sections.push_back(fmt::format("df: {} x {} x {} points", from.df->amplitude.size(),
                                           from.df->frequency.size(), from.df->bias.size()));
  if (from.simulate) summary.sections.push_back(fmt::format("simulate: {} s", from.simulate->duration));
  if (!from.claims.empty()) summary.sections.push_back(fmt::format("claims: {} of the case's own", from.claims.size()));
  if (from.sensitivity)
    summary.sections.push_back(fmt::format("sensitivity: {} parameters, {} samples",
                                           from.sensitivity->parameters.size(), from.sensitivity->samples));
  if (from.identify)
    summary.sections.push_back(
        fmt::format("identify: {} laws, {} records", from.identify->laws.size(), from.identify->records.size()));
  return summary;
}

struct CheckFlags : CommonFlags {
  std::string picture;  ///< --svg
  std::string fit;      ///< --fit
};

int check(CheckFlags flags) {
  take_picture(flags, flags.picture);
  const Case from = load_case(flags);
  if (!flags.picture.empty() && !from.loop) throw std::invalid_argument("--svg: the case holds no loop to draw");
  const auto plants = from.loop ? measured_plants(*from.loop) : std::vector<MeasuredPlantAt>();
  if (!flags.fit.empty() && plants.empty())
    throw std::invalid_argument("--fit: the case has no measured plant (kind = \"frf\"); there is no fit to draw");
  const auto summary = summary_of(from);
  const auto made = provenance(flags, &from);
  Output output(flags);
  Provenance shown = made;
  shown.file = one_line(made.file);
  output.keep_data(from);
  output.check_picture("--svg", flags.picture);
  output.check_picture("--fit", flags.fit);
  if (!flags.fit.empty()) output.picture(flags.fit, fit_picture(plants.front()));
  if (!flags.picture.empty()) output.picture(flags.picture, block_diagram(*from.loop, units_of(from)));
  output.text(check_text(shown, summary));
  if (output.wants_json()) output.json(check_json(made, summary));
  if (output.wants_csv()) output.csv(check_csv(made, summary));
  output.finish();
  return exit_done;
}

void add_check(CLI::App& program, Action& action) {
  const auto flags = std::make_shared<CheckFlags>();
  flags->has_tables = false;
  CLI::App* command = add_command(program, action, "check", "Validate a case file and print a summary", true, flags,
                                  [flags] { return check(*flags); });
  command
      ->add_option("--svg", flags->picture,
                   "Write a block diagram of the loop to FILE (so does -o FILE.svg or FILE.pdf)")
      ->type_name("FILE");
  command->add_option("--fit", flags->fit, "Write a picture of the data of the (first) measured plant and their fit")
      ->type_name("FILE.svg");
}

}  // namespace

Command check_command() {
  return {
      {"check",
       begin_group,
       "Reads a case file, checks every key and every rule between them, and prints a summary of the loop: its "
       "elements, its states, its stability without the elements, and the search box. Of a plant that is known by "
       "measured data it states what they cover, and the order and the error of their fit; --fit draws both. An error "
       "names the file, line, key and value, and what is allowed.",
       {{"limcycle check cases/pid-lugre.toml", "summary of this case"},
        {"limcycle check cases/measured-axis.toml --fit fit.svg", "the same, and a picture of data and fit"},
        {"limcycle check cases/pid-lugre.toml --set loop.controller.kd=12.0", "the same with a different gain"}}},
      add_check};
}

}  // namespace limcycle

#include "limcycle/reports/page/report.hpp"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <sstream>

#include "limcycle/cli/command.hpp"
#include "limcycle/cli/decided.hpp"
#include "limcycle/cli/interrupt.hpp"
#include "limcycle/cli/output/from_page.hpp"
#include "limcycle/cli/output/message.hpp"
#include "limcycle/cli/output/output.hpp"
#include "limcycle/cli/output/progress.hpp"
#include "limcycle/cli/report_parts.hpp"
#include "limcycle/questions/asking/units_of.hpp"
#include "limcycle/reports/csv.hpp"
#include "limcycle/reports/in_units.hpp"
#include "limcycle/reports/json.hpp"
#include "limcycle/reports/largest_swing.hpp"
#include "limcycle/reports/text.hpp"

namespace limcycle {
namespace {

struct ReportFlags : CommonFlags {
  std::string from;  ///< --from
  ReportWishes wishes;
};

/// Settings of the page, for those that the command line does not give.
void take_over(ReportFlags& flags, const CaseInPage& page) {
  if (page.command != "report") return;
  std::istringstream words(page.flags);
  for (std::string word, value; words >> word;) {
    if (word == "--quick") flags.wishes.quick = true;
    if (word == "--remedies") flags.wishes.remedies = true;
    if (word == "--benchmarks") flags.wishes.benchmarks = true;
    if (word == "--x" && words >> value && flags.wishes.x.empty()) flags.wishes.x = value;
    if (word == "--y" && words >> value && flags.wishes.y.empty()) flags.wishes.y = value;
    if (word == "--seed" && words >> value && flags.seed == 0) std::istringstream(value) >> flags.seed;
  }
}

std::string flags_text(const ReportFlags& flags) {
  std::string text;
  if (flags.wishes.quick) text += " --quick";
  if (flags.wishes.remedies) text += " --remedies";
  if (flags.wishes.benchmarks) text += " --benchmarks";
  if (!flags.wishes.x.empty()) text += " --x " + flags.wishes.x + " --y " + flags.wishes.y;
  if (flags.seed != 0) text += " --seed " + std::to_string(flags.seed);
  return text.empty() ? text : text.substr(1);
}

/// File of the page: -o, or the name of the case in the current folder.
std::string page_file(const ReportFlags& flags, const Case& from) {
  std::string file = flags.output;
  if (file.empty()) file = std::filesystem::path(from.file).stem().string() + ".html";
  return file;
}

int exit_code(const LoopReport& report) {
  const bool failed = report.interrupted || report.predict.status == Status::not_finite;
  return failed || !decided(report.predict) ? exit_no_answer : exit_done;
}

int run(ReportFlags flags) {
  const CaseWithPage loaded = load_case_or_page(flags, flags.from);
  const Case& from = loaded.from;
  if (loaded.page) take_over(flags, *loaded.page);
  need_loop(from);
  check_wishes(from, flags.wishes);
  const std::string page = page_file(flags, from);
  if (page == "-" && (flags.json == "-" || flags.csv == "-")) throw refusal("-o -", "stdout holds one document only");
  flags.output = page == "-" ? "/dev/null" : "";
  Output output(flags);
  output.keep_data(from);
  output.keep("the page to be made again", flags.from);
  output.check_page("-o", page);

  const LoopReport report = [&] {
    Progress progress(flags.quiet);
    catch_interrupts();
    return report_parts(from, flags.wishes, flags, progress);
  }();
  const auto made = provenance(flags, &from);
  const Units units = units_of(from, largest_swing(report));
  output.file(page, report_page(in_units(report, units), made, from.text, units, flags_text(flags)));
  Document text = predict_document(from.title, in_units(report.predict, units), units);
  text += page_line(page);
  output.text(first_line(flags, report.predict.status), text);
  const std::string document = predict_json(made, report.predict);
  if (output.wants_json()) output.json(document);
  if (output.wants_csv()) output.csv(predict_csv(report.predict));
  output.finish();
  if (!report.interrupted) compare_with_page(flags, loaded, document);
  tell_cut_short(flags, report.predict.status, "the page holds the results computed so far");
  return exit_code(report);
}

void add_report(CLI::App& program, Action& action) {
  const auto flags = std::make_shared<ReportFlags>();
  CLI::App* command = add_command(program, action, "report", "One self-contained page with the results for the loop",
                                  true, flags, [flags] { return run(*flags); });
  command->get_option("--output")
      ->description("Write the page to FILE, or to stdout alone with - (default: the name of the case, .html)");
  add_from_flag(*command, flags->from);
  command->get_option("--tex")->description("Write the tables as LaTeX to FILE");
  command->get_option("--hdf5")->description("Write the JSON document as HDF5 to FILE");
  command->add_flag("--quick", flags->wishes.quick, "Omit margins, sensitivity and dissipativity");
  command->add_flag("--remedies", flags->wishes.remedies, "Try all remedies, as limcycle remedy does");
  command->add_flag("--benchmarks", flags->wishes.benchmarks, "Chart accuracy and cost of the methods on this loop");
  for (const auto& [name, into] : {std::pair("--x", &flags->wishes.x), std::pair("--y", &flags->wishes.y)})
    command->add_option(name, *into, "With a hunting map: a parameter and its values, as for limcycle map")
        ->type_name("PATH=FROM:TO:N[:log]");
}

}  // namespace

Command report_command() {
  return {
      {"report",
       hunt_group,
       "Writes one page that needs no network: the answer, what would end the hunting, a block diagram of the loop, "
       "all "
       "figures, the verdict on every method, sensitivity, energy balance, provenance and the case file itself. The "
       "page "
       "alone suffices to reproduce the result.",
       {{"limcycle report cases/relay-integrator.toml --quick -o relay.html", "without the slow parts"}}},
      add_report};
}

}  // namespace limcycle

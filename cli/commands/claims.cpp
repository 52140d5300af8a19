#include <CLI/CLI.hpp>
#include <filesystem>

#include "limcycle/cli/command.hpp"
#include "limcycle/cli/interrupt.hpp"
#include "limcycle/cli/option_values.hpp"
#include "limcycle/cli/output/message.hpp"
#include "limcycle/cli/output/output.hpp"
#include "limcycle/cli/output/progress.hpp"
#include "limcycle/reports/claims/claims.hpp"
#include "limcycle/reports/format/table.hpp"

namespace limcycle {
namespace {

struct ClaimsFlags : CommonFlags {
  std::vector<std::string> words;  ///< ids, or a case file before or among them
  std::string html;                ///< --html
  int random = 20;                 ///< --random
  bool list = false;
};

bool is_case(const std::string& word) {
  std::error_code ignored;
  return word.ends_with(".toml") || std::filesystem::is_regular_file(word, ignored);
}

/// The case among the words, if there is one; it is removed from them.
std::optional<Case> case_of(ClaimsFlags& flags) {
  for (auto word = flags.words.begin(); word != flags.words.end(); ++word) {
    if (!is_case(*word)) continue;
    flags.case_file = *word;
    flags.words.erase(word);
    for (const auto& other : flags.words)
      if (is_case(other)) throw refusal("claims", "takes one case file, found '" + other + "' too");
    Case from = load_case(flags);
    if (from.claims.empty())
      throw InputError({.file = from.file,
                        .line = 0,
                        .override = {},
                        .key = "claim",
                        .value = {},
                        .rule = "is required by this command: add [[claim]] with id, quantity and formula",
                        .suggestion = {}});
    return from;
  }
  if (!flags.set.empty()) throw refusal("--set", "needs a case file to change");
  return std::nullopt;
}

/// The claims with those ids or id prefixes, in the order of `all`, each once.
std::vector<Claim> chosen(const std::vector<Claim>& all, const std::vector<std::string>& words) {
  if (words.empty()) return all;
  std::vector<std::string> ids, wanted;
  for (const auto& claim : all) ids.push_back(claim.id);
  for (const auto& word : words) {
    const auto some = claims_named(all, word);
    if (some.empty()) throw refusal("claims", "unknown claim '" + word + "'", suggest(word, ids));
    for (const auto& claim : some) wanted.push_back(claim.id);
  }
  std::vector<Claim> few;
  for (const auto& claim : all)
    if (std::ranges::find(wanted, claim.id) != wanted.end()) few.push_back(claim);
  return few;
}

int list(const ClaimsFlags& flags, const std::vector<Claim>& which, const std::optional<Case>& from) {
  Output output(flags);
  if (from) output.keep_data(*from);
  output.refuse_tables();
  output.text(claims_list(which));
  if (output.wants_json()) output.json(claims_list_json(provenance(flags, from ? &*from : nullptr), which));
  if (output.wants_csv()) output.csv(claims_csv({}));
  output.finish();
  return exit_done;
}

std::vector<TestedClaim> test_all(const std::vector<Claim>& which, const ClaimsFlags& flags) {
  Progress progress(flags.quiet, flags.verbose);
  ClaimRunOptions options;
  options.seed = flags.seed;
  options.random_points = flags.random;
  options.threads = flags.threads;
  options.stop = interrupted;
  options.progress = [&](double share, std::string_view what) { progress.show(share, what); };
  catch_interrupts();
  return run_claims(which, options);
}

/// Arguments that reproduce a page, without the case, which the page adds.
std::string arguments(const ClaimsFlags& flags) {
  std::string out;
  for (const auto& word : flags.words) out += (out.empty() ? "" : " ") + word;
  if (flags.random != 20) out += (out.empty() ? "--random " : " --random ") + std::to_string(flags.random);
  if (flags.seed != 0) out += (out.empty() ? "--seed " : " --seed ") + std::to_string(flags.seed);
  return out;
}

/// Status of the command; a signal after the last test has no effect.
Status ending(const std::vector<TestedClaim>& tested, std::size_t wanted) {
  const bool all = tested.size() == wanted && std::ranges::none_of(tested, [](const auto& one) {
                     return one.result.status == Status::interrupted;
                   });
  return all ? Status::converged : ending_so_far();
}

/// 1 if a verdict is not the expected one; else 3 if some claims were not tested.
int exit_code(const std::vector<TestedClaim>& tested, Status ended) {
  const bool as_expected = std::ranges::all_of(tested, [&](const auto& one) {
    return (ended == Status::interrupted && one.result.status == Status::interrupted) || one.as_expected();
  });
  return !as_expected ? exit_disagreed : tested.empty() || ended == Status::interrupted ? exit_no_answer : exit_done;
}

int run(ClaimsFlags flags) {
  take_page(flags, flags.html);
  const std::optional<Case> from = case_of(flags);
  const auto which = chosen(from ? claims_of(*from) : claims(), flags.words);
  if (flags.list) return list(flags, which, from);
  Output output(flags, from ? &*from : nullptr);
  output.check_page("--html", flags.html);
  const auto tested = test_all(which, flags);
  const Status ended = ending(tested, which.size());
  const auto made = provenance(flags, from ? &*from : nullptr);
  Document text(from ? wrapped(from->title) + "\n" : "");
  text += claims_document(tested, flags.verbose);
  if (!flags.html.empty()) {
    output.file(flags.html, claims_page(tested, made, arguments(flags), from ? from->text : ""));
    text += page_line(flags.html);
  }
  output.text(first_line(flags, ended), text);
  if (output.wants_json()) output.json(claims_json(made, tested, ended));
  if (output.wants_csv()) output.csv(claims_csv(tested));
  output.finish();
  tell_cut_short(flags, ended);
  return exit_code(tested, ended);
}

void add_claims(CLI::App& program, Action& action) {
  const auto flags = std::make_shared<ClaimsFlags>();
  flags->threads = 0;  // claims are tested in parallel; the results do not depend on it
  CLI::App* command = add_command(program, action, "claims", "Analytic claims against numbers", false, flags,
                                  [flags] { return run(*flags); });
  command
      ->add_option("ID", flags->words,
                   "Only these claims, or those whose id begins so; a case file: its own claims ([[claim]])")
      ->type_name("ID|CASE");
  command->add_option("--random", flags->random, "Random points of each claim that has a range of parameters")
      ->type_name("N")
      ->check(whole_in(0, 1'000'000))
      ->capture_default_str();
  command->add_flag("--list", flags->list, "List the claims, test none");
  command->add_option("--html", flags->html, "Write a self-contained page to FILE (so does -o FILE.html)")
      ->type_name("FILE");
}

}  // namespace

Command claims_command() {
  return {
      {"claims",
       evidence_group,
       "Compares analytic statements about describing functions, laws and cycles with the numbers of this program: "
       "each gets a verdict, with a counter-example where it fails. A case may hold claims of its own ([[claim]]). The "
       "exit code is 1 if a verdict is not the expected one.",
       {{"limcycle claims --list", "all claims"},
        {"limcycle claims A1 --verbose", "one claim, with every comparison"},
        {"limcycle claims cases/relay-claims.toml", "the claims of a case"}}},
      add_claims};
}

}  // namespace limcycle

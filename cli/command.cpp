#include "limcycle/cli/command.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <stdexcept>
#include <thread>

#include "build_info.hpp"
#include "limcycle/cli/ranks.hpp"

namespace limcycle {

CLI::App* add_command(CLI::App& program, Action& action, const std::string& name, const std::string& summary,
                      bool takes_case, const std::shared_ptr<CommonFlags>& flags, Action run) {
  CLI::App* command = program.add_subcommand(name, summary);
  if (takes_case) command->add_option("CASE", flags->case_file, "Case file (TOML)")->required()->type_name("FILE");
  command->add_option("--set", flags->set, "Replace a value of the case: PATH=VALUE, VALUE in TOML syntax; repeatable")
      ->type_name("PATH=VALUE")
      ->allow_extra_args(false);
  command->add_option("--json", flags->json, "Write the JSON document to FILE, or to stdout alone with -")
      ->type_name("FILE|-");
  command->add_option("--csv", flags->csv, "Write the CSV document to FILE, or to stdout alone with -")
      ->type_name("FILE|-");
  command->add_option("-o,--output", flags->output, "Write the text to FILE instead of stdout")->type_name("FILE");
  command->add_option("--seed", flags->seed, "Seed of everything random")
      ->type_name("N")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_option("--threads", flags->threads, "Threads; 0: one a core")
      ->type_name("N")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  std::vector<std::string> sets{"auto"};
  for (const Isa isa : all_isas()) sets.emplace_back(to_string(isa));
  command
      ->add_option("--isa", flags->isa,
                   "Instruction set of the kernels: auto (the widest that this machine has) or one of those listed")
      ->check(CLI::IsMember(sets))
      ->type_name("NAME")
      ->capture_default_str();
  command->add_flag("--quiet", flags->quiet, "No progress bar and no messages but errors");
  command->callback([&action, run = std::move(run)] { action = run; });
  return command;
}

Case load_case(const CommonFlags& flags) { return load_case(flags.case_file, flags.set); }

Isa instruction_set(const CommonFlags& flags) {
  const Isa isa = flags.isa == "auto" ? isa_of_ranks() : isa_named(flags.isa).value();
  if (!is_available(isa)) throw std::invalid_argument("--isa: this machine has no " + flags.isa);
  return isa;
}

Provenance provenance(const CommonFlags& flags, const Case* from) {
  Provenance made;
  made.version = build_info::version;
  made.commit = build_info::commit;
  made.compiler = build_info::compiler;
  made.build_type = build_info::build_type;
  instruction_set(flags);  // one that this machine lacks is refused by every command
  made.isa = to_string(Isa::scalar);
  made.seed = flags.seed;
  // Of the machine, also where mpirun gives this process a part of it: a result has the same bytes either way.
  made.threads =
      flags.threads > 0 ? flags.threads : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  if (from != nullptr) {
    made.title = from->title;
    made.file = from->file;
    made.sha256 = from->sha256;
    made.overrides = from->overrides;
  }
  return made;
}

InputError refusal(const std::string& key, const std::string& rule, const std::string& suggestion) {
  return InputError(
      {.file = {}, .line = 0, .override = {}, .key = key, .value = {}, .rule = rule, .suggestion = suggestion});
}

}  // namespace limcycle

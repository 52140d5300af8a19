#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>

#include "limcycle/analysis/study/identify/free/synthesize_free.hpp"
#include "limcycle/cli/asking_of.hpp"
#include "limcycle/cli/command.hpp"
#include "limcycle/cli/option_values.hpp"
#include "limcycle/cli/output/message.hpp"
#include "limcycle/cli/output/output.hpp"
#include "limcycle/cli/output/progress.hpp"
#include "limcycle/reports/identify/identify.hpp"
#include "limcycle/reports/identify/synthesize.hpp"

namespace limcycle {
namespace {

struct SynthesizeFlags : CommonFlags {
  RigFaults faults;
  bool free = false;   ///< --free
  bool force = false;  ///< --force
};

const Element& law_to_synthesize(const Case& from) {
  const Element& law = df_element(from);
  if (!law.is_friction())
    throw InputError({.file = from.file,
                      .line = 0,
                      .override = {},
                      .key = "loop.friction",
                      .value = {},
                      .rule = "is required by this command: records are of a friction law",
                      .suggestion = {}});
  return law;
}

/// The files that are written into the folder: records in the order of their kinds, then the case.
std::vector<std::string> files_in(const SynthesizeFlags& flags) {
  const std::filesystem::path folder = flags.output;
  std::vector<std::string> files;
  for (std::size_t i = 0; i < std::size(record_kinds); ++i)
    if (flags.free || !is_free(static_cast<RecordKind>(i)))
      files.push_back((folder / record_kinds[i]).string() + ".csv");
  files.push_back((folder / "identify.toml").string());
  return files;
}

void check_folder(const SynthesizeFlags& flags) {
  if (flags.output.empty()) throw refusal("--output", "is required: the folder for the records and their case");
  std::error_code failed;
  if (std::filesystem::exists(flags.output, failed) && !std::filesystem::is_directory(flags.output, failed))
    throw refusal("--output " + flags.output, "is no folder");
  for (const auto& file : files_in(flags))
    if (!flags.force && std::filesystem::exists(file, failed))
      throw refusal("--output " + flags.output, "holds " + file + " already", "--force replaces it");
}

/// The folder for the files; one that was made for them goes again if nothing was written.
class FolderForFiles {
 public:
  explicit FolderForFiles(const std::string& path) : path_(path) {
    std::error_code failed;
    made_ = std::filesystem::create_directories(path, failed);
    if (failed) throw refusal("--output " + path, "cannot be made: " + failed.message());
  }
  ~FolderForFiles() {
    std::error_code not_empty;
    if (made_) std::filesystem::remove(path_, not_empty);
  }
  FolderForFiles(const FolderForFiles&) = delete;
  FolderForFiles& operator=(const FolderForFiles&) = delete;

 private:
  std::string path_;
  bool made_ = false;
};

/// `failure`: why there are no free motions, of those that were asked for.
std::vector<FrictionRecord> synthesized(const SynthesizeFlags& flags, const Case& from, const Element& law,
                                        std::string& failure) {
  Progress progress(flags.quiet, flags.verbose);
  const Asking asking = asking_of(flags, progress);
  std::vector<FrictionRecord> records = synthesize(law, flags.faults, flags.seed, asking.stop);
  if (records.empty()) throw NoAnswer("stopped before the records were complete, so that none is written");
  if (!flags.free) return records;
  const FreeRig rig = rig_of(from);
  try {
    for (auto& one : synthesize_free(law, rig, flags.faults, flags.seed)) records.push_back(std::move(one));
  } catch (const std::invalid_argument& reason) {
    failure = std::string("no free motion is written: ") + reason.what();
  }
  return records;
}

/// The case that identifies the law of these records, checked by reading it.
std::string case_of(const Case& from, const Element& law, const std::vector<FrictionRecord>& records,
                    const std::string& file) {
  std::vector<std::string> names;
  names.reserve(records.size());
  for (const auto& one : records) names.push_back(one.name + ".csv");
  std::string text = from.text + (from.text.ends_with('\n') ? "\n" : "\n\n") +
                     identify_section(std::string(law.kind()), records, names);
  try {
    read_case(text, file);  // files that it names may be out of reach there
  } catch (const InputError& unusable) {
    if (std::ranges::find(record_kinds, unusable.fault().key) == std::end(record_kinds)) throw;  // of the case itself
    throw NoAnswer(std::string("the records of this law are not usable, so that none is written: ") + unusable.what());
  }
  return text;
}

int run(SynthesizeFlags flags) {
  const Case from = load_case(flags);
  if (from.identify) throw refusal("CASE", "has an [identify] section already");
  const Element& law = law_to_synthesize(from);
  check_folder(flags);
  const auto files = files_in(flags);
  const FolderForFiles folder(std::exchange(flags.output, {}));
  Output output(flags);
  output.keep_data(from);
  for (const auto& file : files) output.check_file("--output", file);
  std::string failure;
  const auto records = synthesized(flags, from, law, failure);
  SynthesizeReport report{law, flags.faults, {}, files.back()};
  for (std::size_t i = 0; i < records.size(); ++i)
    report.records.push_back({records[i].kind, files[i], std::max(records[i].t.size(), records[i].F.size())});
  const std::string text = case_of(from, law, records, report.case_file);
  for (std::size_t i = 0; i < records.size(); ++i) output.file(files[i], record_csv(records[i]));
  output.file(report.case_file, text);
  output.text(synthesize_text(from.title, report));
  if (output.wants_json()) output.json(synthesize_json(provenance(flags, &from), report));
  if (output.wants_csv()) output.csv(synthesize_csv(report));
  output.finish();
  if (!from.overrides.empty()) tell(flags, "the values of --set are in the records, but not in " + report.case_file);
  if (!failure.empty()) throw NoAnswer(failure);
  return exit_done;
}

void add_synthesize(CLI::App& program, Action& action) {
  const auto flags = std::make_shared<SynthesizeFlags>();
  flags->has_tables = false;
  CLI::App* command = add_command(program, action, "synthesize",
                                  "Write the records of a rig with the case's friction law, to test `identify`", true,
                                  flags, [flags] { return run(*flags); });
  const auto share = [&](const char* name, double& value, const char* meaning, double most) {
    command->add_option(name, value, meaning)->type_name("X")->check(number_in(0.0, most))->capture_default_str();
  };
  share("--noise", flags->faults.noise, "Noise of the force, as a share of the record's largest force", 1.0);
  share("--drift", flags->faults.drift, "Drift of the force over a record, as such a share", 1.0);
  share("--ripple", flags->faults.ripple, "Ripple of the force over the position, as such a share", 1.0);
  share("--jitter", flags->faults.jitter, "Jitter of the sampling, as a share of the sample time", 0.2);
  share("--quantum", flags->faults.quantum, "Encoder step, m; then no velocity is recorded", 1.0);
  command->add_flag("--free", flags->free, "Also the free motion of the case's plant: under a force, and let go");
  command->add_flag("--force", flags->force, "Replace the files in FOLDER that it writes");
}

}  // namespace

Command synthesize_command() {
  return {{"synthesize",
           trust_group,
           "Writes records that a rig with the friction law of the case would give, with noise and other faults of "
           "measurement, and a case that `identify` fits to them. As the true numbers are known, it shows what such "
           "records "
           "can determine.",
           {{"limcycle synthesize cases/pid-lugre.toml --noise 0.02 --seed 3 -o rig", "2 % noise of the force"},
            {"limcycle synthesize cases/pid-lugre.toml --free -o free-rig", "free motions of the mass too"}}},
          add_synthesize};
}

}  // namespace limcycle

#include "limcycle/cli/output/from_page.hpp"
#include "limcycle/cli/output/message.hpp"

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "build_info.hpp"

namespace limcycle {
namespace {

constexpr std::size_t largest_page = std::size_t{64} << 20;

InputError page_refused(const std::string& file, const std::string& rule) {
  return InputError({.file = file, .line = 0, .override = {}, .key = {}, .value = {}, .rule = rule, .suggestion = {}});
}

std::string page_text(const std::string& file) {
  std::error_code failed;
  if (!std::filesystem::exists(file, failed)) throw page_refused(file, "no such file");
  if (std::filesystem::is_directory(file, failed)) throw page_refused(file, "is a directory, not a page");
  errno = 0;
  std::ifstream in(file, std::ios::binary);
  if (!in) throw page_refused(file, std::string("cannot be read: ") + std::strerror(errno));
  std::string text(largest_page + 1, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (in.bad()) throw page_refused(file, "cannot be read");
  text.resize(static_cast<std::size_t>(in.gcount()));
  if (text.size() > largest_page) throw page_refused(file, "is larger than 64 MiB: no page of limcycle is");
  return text;
}

CaseWithPage load_page(const CommonFlags& flags, const std::string& file) {
  const std::string text = page_text(file);
  CaseWithPage loaded;
  try {
    loaded.page = case_in_page(text);
    loaded.result = result_in_page(text);
  } catch (const PageError& error) {
    throw page_refused(file, error.what());
  }
  if (sha256(loaded.page->text) != loaded.page->sha256)
    throw page_refused(file, "was altered: the case in it does not have the SHA-256 that the page states");
  auto overrides = loaded.page->overrides;
  overrides.insert(overrides.end(), flags.set.begin(), flags.set.end());
  loaded.from = read_case(loaded.page->text, loaded.page->file, overrides);
  return loaded;
}

}  // namespace

void add_from_flag(CLI::App& command, std::string& page) {
  command.get_option("CASE")->required(false);
  command.add_option("--from", page, "Instead of CASE: a page written by limcycle, which holds its case")
      ->type_name("PAGE.html");
}

CaseWithPage load_case_or_page(const CommonFlags& flags, const std::string& page) {
  if (page.empty() && flags.case_file.empty())
    throw refusal({}, "a case is needed: CASE, or --from with a page that holds one");
  if (!page.empty() && !flags.case_file.empty())
    throw refusal("--from " + page, "takes the place of CASE; give one of them");
  if (!page.empty()) return load_page(flags, page);
  return {load_case(flags), {}, {}};
}

void compare_with_page(const CommonFlags& flags, const CaseWithPage& loaded, const std::string& document) {
  if (!loaded.page || flags.quiet) return;
  const bool other = loaded.page->version != build_info::version;
  if (other)
    tell(flags,
         "the page was written by version " + one_line(loaded.page->version, 40) + ", this is " + build_info::version);
  if (!flags.set.empty() || loaded.result.empty() || same_result(loaded.result, document)) return;
  tell(flags, std::string("the answer differs from the one on the page") + (other ? "" : ": please report this"));
}

}  // namespace limcycle

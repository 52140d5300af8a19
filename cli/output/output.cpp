#include "limcycle/cli/output/output.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <utility>

#include "limcycle/cases/loader/text/printable.hpp"
#include "limcycle/cli/output/colour.hpp"
#include "limcycle/cli/output/pdf.hpp"
#include "limcycle/cli/output/write_all.hpp"
#include "limcycle/cli/ranks/ranks.hpp"
#include "limcycle/questions/asking/provenance_of.hpp"
#include "limcycle/questions/asking/words.hpp"
#include "limcycle/reports/export/hdf5.hpp"

namespace limcycle {
namespace {

bool written_to(std::ostream& out, std::string_view document) {
  return static_cast<bool>(out.write(document.data(), static_cast<std::streamsize>(document.size())).flush());
}

/// Canonical name of a file, links resolved; the file need not exist. Empty if that fails.
std::filesystem::path full_name(const std::string& path) {
  std::error_code failed;
  const auto name = std::filesystem::weakly_canonical(std::filesystem::absolute(path, failed), failed);
  return failed ? std::filesystem::path() : name;
}

/// A new file in the folder of `target`, without a name if the file system allows it, so that a process that is killed
/// leaves nothing behind. When complete and on the disk, it replaces `target`.
class Draft {
 public:
  explicit Draft(const std::filesystem::path& target) : target_(target) {
    constexpr std::size_t longest = 230;  // of a name, which may have 255 bytes, without the ending
    const std::filesystem::path folder = target.parent_path();
    name_ = (folder / target.filename().string().substr(0, longest)).string() + ".part" + std::to_string(getpid());
    if (access("/proc/self/fd", X_OK) == 0)  // needed to give the file a name
      file_ = open(folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666);
    named_ = file_ < 0;
    if (named_) file_ = open(name_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  }
  ~Draft() {
    const int reason = errno;
    if (file_ >= 0) close(file_);
    if (named_) unlink(name_.c_str());
    errno = reason;
  }
  Draft(const Draft&) = delete;
  Draft& operator=(const Draft&) = delete;

  bool write(std::string_view document) const {
    if (file_ < 0 || !write_all(file_, document)) return false;
    return (fsync(file_) == 0 || errno == EINVAL || errno == EROFS);  // not every file system supports it
  }

  bool take_place() {
    struct stat before {};
    if (stat(target_.c_str(), &before) == 0 && fchmod(file_, before.st_mode & 07777U) != 0) return false;
    if (!named_) {
      if (takes(target_)) return true;  // where no file stands in the way, at once
      unlink(name_.c_str());            // left by an earlier process with the same id
      named_ = takes(name_);
      if (!named_) return false;
    }
    if (rename(name_.c_str(), target_.c_str()) != 0) return false;
    named_ = false;
    return true;
  }

 private:
  /// Gives the file without a name this one, if it is free.
  bool takes(const std::string& name) const {
    const std::string held = "/proc/self/fd/" + std::to_string(file_);
    return linkat(AT_FDCWD, held.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0;
  }

  std::filesystem::path target_;
  std::string name_;
  int file_ = -1;
  bool named_ = false;
};

/// Replaces a file by `document` only when that is complete on the disk: a failed write leaves the old file unchanged.
bool replaced(const std::string& path, std::string_view document) {
  namespace fs = std::filesystem;
  std::error_code failed;
  if (fs::exists(path, failed) && !fs::is_regular_file(path, failed)) {  // devices and pipes are written, not replaced
    std::ofstream out(path, std::ios::binary);
    return written_to(out, document);
  }
  const fs::path target = full_name(path);  // a link stays a link
  if (target.empty()) return false;
  Draft draft(target);
  return draft.write(document) && draft.take_place();
}

/// True if both names refer to one file, existing or not. A device may be named twice.
bool same_file(const std::string& one, const std::string& other) {
  namespace fs = std::filesystem;
  if (one == "-" || other == "-") return one == other;
  std::error_code failed;
  if (fs::exists(one, failed) && !fs::is_regular_file(one, failed)) return false;
  if (fs::equivalent(one, other, failed)) return true;
  const fs::path first = full_name(one);
  return !first.empty() && first == full_name(other);
}

/// Endings of --output that promise another document than text, and whether some commands write it.
struct Promise {
  std::string_view ending;
  bool kept;
};
constexpr std::array<Promise, 7> promises{{{".html", true},
                                           {".htm", true},
                                           {".svg", true},
                                           {".pdf", true},
                                           {".tex", true},
                                           {".png", false},
                                           {".eps", false}}};

const Promise* promised_by(const std::string& path) {
  const auto* found = std::ranges::find_if(promises, [&](const Promise& one) { return path.ends_with(one.ending); });
  return found == promises.end() ? nullptr : found;
}

/// Throws for the name of a file that would not hold what it promises: pages and pictures have been taken off --output.
void check_holds_text(const std::string& path) {
  const Promise* promised = promised_by(path);
  if (promised == nullptr) return;
  throw refusal("--output " + path, "would hold plain text: this command writes no " + std::string(promised->ending),
                "choose another name, such as " + path.substr(0, path.size() - promised->ending.size()) +
                    ".txt; see --help for pages and pictures");
}

/// 0, or the error in writing a document, which is written next to the file that it then replaces.
int cannot_be_replaced(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code failed;
  const auto status = fs::status(path, failed);
  if (failed == std::errc::filename_too_long) return ENAMETOOLONG;
  if (fs::is_directory(status)) return EISDIR;
  // Devices and pipes are opened only when there is something to write.
  if (fs::exists(status) && !fs::is_regular_file(status)) return 0;
  if (fs::exists(status) && access(path.c_str(), W_OK) != 0) return errno;
  const fs::path folder = full_name(path).parent_path();
  return access(folder.c_str(), W_OK | X_OK) == 0 ? 0 : errno;
}

}  // namespace

void check_some_command_writes(const std::string& output) {
  const Promise* promised = promised_by(output);
  if (promised == nullptr || promised->kept) return;
  throw refusal(
      "--output " + output, "no command writes " + std::string(promised->ending),
      "a picture is -o FILE.svg or FILE.pdf, a page -o FILE.html, tables are -o FILE.tex; --help shows which of them a "
      "command has. The Python module also saves figures as PNG and PGF");
}

void take_page(CommonFlags& flags, std::string& page) {
  if (page.empty() && flags.output.ends_with(".html")) page = std::exchange(flags.output, {});
}

void take_picture(CommonFlags& flags, std::string& picture) {
  if (picture.empty() && (flags.output.ends_with(".svg") || flags.output.ends_with(".pdf")))
    picture = std::exchange(flags.output, {});
}

Output::Output(const CommonFlags& flags, const Case* from)
    : tex_(flags.tex), json_(flags.json), hdf5_(flags.hdf5), csv_(flags.csv), case_(flags.case_file) {
  std::string output = flags.output;
  if (tex_.empty() && flags.has_tables && output.ends_with(".tex")) tex_ = std::exchange(output, {});
  if (hdf5_.empty() && (output.ends_with(".h5") || output.ends_with(".hdf5"))) hdf5_ = std::exchange(output, {});
  if (hdf5_ == "-") throw refusal("--hdf5 -", "HDF5 goes to a file", "name one, such as result.h5");
  keep("the case file", flags.case_file);
  if (from != nullptr) {
    keep_data(*from);
    basis_ = basis_lines(*from);
  }
  text_ = !output.empty() ? output : json_ == "-" || csv_ == "-" ? "" : "-";
  colours_ = text_ == "-" && colours_wanted(flags.color, STDOUT_FILENO);
  check_holds_text(output);
  check_file("--output", output);
  check_file("--tex", tex_);
  check_file("--json", json_);
  check_file("--hdf5", hdf5_);
  check_file("--csv", flags.csv);
}

void Output::check_case_file(const std::string& path, const Case& from) {
  check_file("-o", path);
  if (path.empty() || data_of(from).empty()) return;
  const std::filesystem::path folder = full_name(from.file).parent_path();
  if (full_name(path).parent_path() != folder)
    throw refusal("-o " + path, "the case names files of data, which are found from its own folder",
                  "write it to " + folder.string());
}

void Output::keep_data(const Case& from) {
  const auto folder = std::filesystem::path(from.file).parent_path();
  for (const CaseData& data : data_of(from)) keep("the data of " + data.path, (folder / data.file).string());
}

void Output::keep(const std::string& what, const std::string& path) {
  if (path.empty() || path == "-") return;
  for (const auto& one : taken_)
    if (!one.flag.empty() && same_file(one.path, path)) throw refusal(one.flag + " " + one.path, "is " + what);
  taken_.push_back({{}, path, what});
}

void Output::keep_store(const std::string& path) {
  keep("the store", path);
  if (path.empty()) return;
  for (const char* ending : {"-wal", "-shm", "-journal", "-lock"}) keep("a file of the store", path + ending);
}

void Output::check_file(const std::string& flag, const std::string& path) {
  if (path.empty() || rank() > 0) return;
  for (const auto& one : taken_)
    if (same_file(path, one.path)) throw refusal(flag + " " + path, "is " + one.what);
  taken_.push_back({flag, path, "where " + flag + " goes already"});
  if (path == "-") {
    if (flag != "--output") text_.clear();
    return;
  }
  if (const int reason = cannot_be_replaced(path); reason != 0)
    throw refusal(flag + " " + path, std::string("cannot be written: ") + std::strerror(reason));
}

void Output::text(std::string_view document) {
  const std::string shown = printable(std::string(document) + basis_);
  write(text_, colours_ ? coloured(shown) : shown);
}

void Output::text(const std::string& first, const Document& document) {
  text(first + document.text());
  if (!tex_.empty())
    write(tex_, document.latex("limcycle " + provenance_of(0, 1, nullptr).version +
                               (case_.empty() ? "" : ": " + printable(case_))));
}

void Output::check_page(const std::string& flag, const std::string& path) {
  const Promise* promised = promised_by(path);
  const bool table =
      path.ends_with(".h5") || path.ends_with(".hdf5") || path.ends_with(".json") || path.ends_with(".csv");
  if (table || (promised != nullptr && !promised->ending.starts_with(".htm")))
    throw refusal(flag + " " + path, "would hold a page",
                  "name it .html, which a browser prints to PDF; --help shows the flags of other documents");
  check_file(flag, path);
}

void Output::check_picture(const std::string& flag, const std::string& path) {
  check_file(flag, path);
  if (path.ends_with(".pdf") && rank() == 0 && !makes_pdf())
    throw refusal(flag + " " + path, "PDF needs the program rsvg-convert, which is not installed",
                  "install librsvg2-bin, or name an .svg");
}

void Output::picture(const std::string& path, std::string_view svg) {
  if (path.empty() || rank() > 0) return;
  if (!path.ends_with(".pdf")) return write(path, svg);
  const auto pdf = pdf_of(svg);
  if (pdf)
    write(path, *pdf);
  else if (failure_.empty())
    failure_ = "cannot make " + path + ": rsvg-convert failed";
}

void Output::json(std::string_view document) {
  write(json_, document);
  if (!hdf5_.empty() && rank() == 0) write(hdf5_, hdf5_document(document));
}

void Output::write(const std::string& path, std::string_view document) {
  if (path.empty() || rank() > 0) return;
  if (path == "-") {
    // The text went through printable() before it was coloured.
    const bool raw = path != text_ && isatty(STDOUT_FILENO) == 1;
    shown_ += raw ? printable(document) : document;
    return;
  }
  errno = 0;
  if (!replaced(path, document)) fail(path);
}

void Output::fail(const std::string& where) {
  if (failure_.empty())
    failure_ = "cannot write to " + where + (errno != 0 ? std::string(": ") + std::strerror(errno) : "");
}

void Output::refuse_tables() const {
  if (!tex_.empty()) throw refusal("--tex " + tex_, "this question has no tables");
}

void Output::finish() {
  errno = 0;
  if (!shown_.empty() && !written_to(std::cout, shown_)) fail("stdout");
  shown_.clear();
  if (!failure_.empty()) throw OutputError(failure_);
}

}  // namespace limcycle

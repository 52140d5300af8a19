#pragma once
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "limcycle/cli/command.hpp"
#include "limcycle/reports/format/document.hpp"

namespace limcycle {

/// A result could not be written (full disk, closed pipe): exit code 3.
class OutputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Throws for a name of --output that promises a document which no command writes, such as a PDF.
void check_some_command_writes(const std::string& output);

/// The file of -o, if its ending says that it is to hold a page (.html), or a picture (.svg, .pdf), and no flag named
/// another: moved into `page` or `picture`.
void take_page(CommonFlags& flags, std::string& page);
void take_picture(CommonFlags& flags, std::string& picture);

/// Destinations of a command's documents, from its flags: the text to stdout or to --output, JSON, HDF5 and CSV to
/// their files. With "-" for any document stdout receives that one and nothing else; the text is then dropped unless
/// --output names a file for it.
///
/// The constructor checks before anything is computed that every file can be written and that none replaces another or
/// an input of the command, under any name; it throws InputError otherwise. No file is created before its document is
/// complete. With several ranks only rank 0 touches any file.
class Output {
 public:
  /// `from`: the case of the results; of a case with measured plants the text then ends with what it rests on.
  explicit Output(const CommonFlags& flags, const Case* from = nullptr);
  Output(const Output&) = delete;
  Output& operator=(const Output&) = delete;

  bool wants_json() const { return !json_.empty() || !hdf5_.empty(); }
  bool wants_csv() const { return !csv_.empty(); }

  /// Write the whole document at once, into a new file that then replaces the old one, so that a full disk never costs
  /// an older result. An error is kept for finish(), so that the other documents are still written. On a terminal the
  /// text is coloured as --color asks. The text shows terminal controls as escapes (see printable()), and so does any
  /// document that goes to a terminal.
  void text(std::string_view document);
  /// The same for a document with tables, which go to --tex too; `first`: a line before it.
  void text(const std::string& first, const Document& document);
  void json(std::string_view document);  ///< and HDF5, which is made of it
  void csv(std::string_view document) { write(csv_, document); }

  /// The files of data that a case names: no document may go there.
  void keep_data(const Case& from);

  /// A file that the command reads or writes by itself, `what` in words ("the store"): no document may go there. An
  /// empty path is ignored.
  void keep(const std::string& what, const std::string& path);

  /// The store of a sweep, with the files that SQLite and the sweep keep beside it.
  void keep_store(const std::string& path);

  /// Any other file (an HTML page, say) under the same rules: check_file() first, then, when the document is ready,
  /// file().
  void check_file(const std::string& flag, const std::string& path);
  void file(const std::string& path, std::string_view document) { write(path, document); }
  /// For a question without tables: throws if --tex asks for them.
  void refuse_tables() const;
  /// A page, whose name may not promise another document.
  void check_page(const std::string& flag, const std::string& path);
  /// A picture: SVG as it is, or as PDF where the path ends with .pdf.
  void check_picture(const std::string& flag, const std::string& path);
  void picture(const std::string& path, std::string_view svg);
  /// The same for a changed case (-o), which finds the files of data that it names only from their folder.
  void check_case_file(const std::string& path, const Case& from);

  /// Writes what goes to stdout, last, so that a reader that closes a pipe early costs no file. Throws OutputError
  /// naming the first document that could not be written completely.
  void finish();

 private:
  void write(const std::string& path, std::string_view document);
  void fail(const std::string& where);  ///< with errno

  std::string text_, tex_, json_, hdf5_, csv_;  // "-" is stdout, empty: none
  std::string case_;                            // for a comment
  std::string basis_;                           // sentences at the end of the text
  std::string shown_;                           // for stdout
  bool colours_ = false;
  struct TakenFile {
    std::string flag;  // of the document that goes there; empty for a file that the command reads
    std::string path, what;
  };
  std::vector<TakenFile> taken_;
  std::string failure_;
};

}  // namespace limcycle

#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "limcycle/cases/loader/text/input_error.hpp"

/// Internals of the loader: a case file as a tree of values, and the functions that read it.
namespace limcycle::case_file {

/// One value of a case file with its place.
struct Value {
  struct Entry;
  struct Other {
    std::string type;  ///< "date" and the like, which no key of a case accepts
  };
  using List = std::vector<Value>;
  using Table = std::vector<Entry>;

  std::variant<Table, bool, std::int64_t, double, std::string, Other, List> data;
  int line = 0;       ///< in the file, from 1; 0: not written in the file
  int override = -1;  ///< index of the --set that set it; -1: the file

  template <class T>
  const T* as() const {
    return std::get_if<T>(&data);
  }

  /// Entry of a table, or null (also when this is not a table).
  const Value* find(std::string_view key) const;
  /// Text of such an entry, or null (also when the entry is no text).
  const std::string* text(std::string_view key) const;
  /// The value at a dotted path, or null.
  const Value* at(std::string_view path) const;
};

struct Value::Entry {
  std::string key;
  Value value;
};

/// "number", "string", ... for messages.
std::string type_name(const Value& value);

/// The value as TOML on one line, at most about 60 characters.
std::string written(const Value& value);

/// A case file as a tree, with its overrides already applied; it makes errors that name their place.
struct Document {
  Value root;
  std::string file;
  std::vector<std::string> overrides;

  /// A file that the case names, as the program finds it: relative to the folder of the case.
  std::string beside(const std::string& named) const;

  /// The error to throw for the value at `key`; `where` is that value, or the table in which it is missing.
  InputError error(const Value& where, const std::string& key, const std::string& rule,
                   const std::string& suggestion = {}, const std::string& value = {}) const;

  /// The same for a path such as "loop.controller.tf": the error names the deepest part of it that exists, and shows
  /// its value if that is the whole path.
  InputError error_at(const std::string& path, const std::string& rule) const;
};

/// Bytes of a file. Throws InputError if it is missing, a directory, unreadable or larger than `largest_case_file`, and
/// if it is empty, binary or not UTF-8.
std::string read_text(const std::string& file);

/// The checks of read_text() on the text itself.
void check_text(std::string_view text, const std::string& file);

/// Position of the first value or key that is nested more deeply than any case needs (32 brackets, 16 dots), npos if
/// there is none. The parser recurses over nested values, and so do the destructors of its result over dotted keys:
/// without a limit a hostile file causes a stack overflow.
std::size_t nested_too_deep(std::string_view text);

/// Parses TOML 1.0. Throws InputError with line and column.
Document parse(std::string_view text, const std::string& file);

/// Names the blocks of a diagram: each table of the list `diagram.block` becomes the table `diagram.NAME`, so that its
/// numbers have paths as all others do. Called by parse(). Throws InputError for a name that is missing, taken or no
/// name.
void name_blocks(Document& document);

/// Calls `use` with every part of [loop] and block of [diagram], and its path.
void for_each_part(Document& document, const std::function<void(Value& part, const std::string& path)>& use);

/// Applies "PATH=VALUE": replaces or creates the value at PATH. Throws InputError naming the override.
void apply_override(Document& document, const std::string& override);

/// VALUE of an override, parsed as TOML. Throws std::invalid_argument with the error.
Value parse_value(std::string_view text, int override);

}  // namespace limcycle::case_file

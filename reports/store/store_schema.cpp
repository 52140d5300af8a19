#include "limcycle/reports/store/store_schema.hpp"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <limits>
#include <utility>

#include "limcycle/analysis/random_bits.hpp"
#include "limcycle/reports/format/json_values.hpp"
#include "limcycle/reports/memory.hpp"

namespace limcycle {
namespace {

constexpr std::int64_t store_schema = 1;
constexpr std::int64_t store_application = 0x4C435357;  // "LCSW"
static_assert(std::numeric_limits<double>::is_iec559, "rows are stored as IEEE doubles");

/// A list as one JSON text, readable in the database by other programs.
std::string list_text(const std::vector<std::string>& list) { return json_text(Json(list)); }

struct IdentityField {
  const char* key;
  const char* name;  ///< in messages; null: not compared
  std::string value;
};

std::vector<IdentityField> identity_fields(const SweepIdentity& identity) {
  return {{"command", "the command", identity.command},
          {"title", nullptr, identity.title},
          {"case_file", nullptr, identity.case_file},
          {"case_sha256", "the case file (SHA-256)", identity.case_sha256},
          {"overrides", "--set", list_text(identity.overrides)},
          {"design", "the design", identity.design},
          {"seed", "the seed", std::to_string(identity.seed)},
          {"columns", "the columns", list_text(identity.columns)},
          {"points", "the number of points", std::to_string(identity.points)},
          {"version", "the program's version", identity.version},
          {"commit", "the program's commit", identity.commit},
          {"isa", "the instruction set", identity.isa}};
}

/// The part of a long text in which it differs from another one.
std::string excerpt(const std::string& text, const std::string& other) {
  constexpr std::size_t longest = 48;
  if (text.size() <= longest) return "'" + text + "'";
  std::size_t same = 0;
  while (same < text.size() && same < other.size() && text[same] == other[same]) ++same;
  const std::size_t first = same < longest / 2 ? 0 : same - longest / 2;
  const bool whole = first + longest >= text.size();
  return fmt::format("'{}{}{}'", first > 0 ? "..." : "", text.substr(first, longest), whole ? "" : "...");
}

StoreError damaged_store(const std::string& path, const std::string& what) {
  return {StoreError::Kind::failed, fmt::format("{} is damaged: {}; compute it again into another file", path, what)};
}

std::uint64_t unsigned_number(const std::string& text, const std::string& path) {
  try {
    std::size_t read = 0;
    const std::uint64_t value = std::stoull(text, &read);
    if (read == text.size()) return value;
  } catch (const std::logic_error&) {
    // falls through to the error
  }
  throw damaged_store(path, "'" + text + "' stands where a number should");
}

std::vector<std::string> text_list(const std::string& text, const std::string& path) {
  try {
    return Json::parse(text).get<std::vector<std::string>>();
  } catch (const Json::exception&) {
    throw damaged_store(path, "'" + text + "' stands where a list should");
  }
}

/// A sweep keeps all rows in memory; a number that is too large may also be damage.
void require_memory(std::size_t points, std::size_t columns, const std::string& path) {
  const double bytes = static_cast<double>(points) * (8.0 * static_cast<double>(columns) + 0.125);
  if (const std::string lack = lack_of_memory(bytes); !lack.empty())
    throw StoreError(StoreError::Kind::failed,
                     fmt::format("{} is of {} points, each with {} numbers, and {}", path, points, columns, lack));
}

void numbers_of(std::span<const unsigned char> bytes, std::span<double> numbers) {
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    std::uint64_t bits = 0;
    for (std::size_t k = 8; k-- > 0;) bits = bits << 8 | bytes[8 * i + k];
    numbers[i] = std::bit_cast<double>(bits);
  }
}

}  // namespace

StoreContent content_of(Database& database) {
  try {
    const bool empty = database.number("SELECT count(*) FROM sqlite_master") == 0;
    const std::int64_t owner = database.number("PRAGMA application_id");
    if (empty && (owner == 0 || owner == store_application)) return StoreContent::nothing;
    if (owner != store_application) return StoreContent::other;
    return database.number("PRAGMA user_version") > store_schema ? StoreContent::newer : StoreContent::sweep;
  } catch (const DatabaseError& error) {
    if (error.not_a_database()) return StoreContent::no_database;
    throw;
  }
}

void make_tables(Database& database, const SweepIdentity& identity) {
  database.run(fmt::format("PRAGMA application_id = {}; PRAGMA user_version = {};", store_application, store_schema));
  database.run(
      "CREATE TABLE identity(key TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;"
      "CREATE TABLE sessions(id INTEGER PRIMARY KEY, began REAL NOT NULL, written REAL NOT NULL, rows INTEGER NOT "
      "NULL);"
      "CREATE TABLE rows(point INTEGER PRIMARY KEY, numbers BLOB NOT NULL, checksum INTEGER NOT NULL);");
  Statement insert(database, "INSERT INTO identity VALUES(?, ?)");
  for (const auto& field : identity_fields(identity)) {
    insert.bind(1, std::string_view(field.key));
    insert.bind(2, std::string_view(field.value));
    insert.run();
  }
}

SweepIdentity read_identity(Database& database, const std::string& path) {
  Statement select(database, "SELECT value FROM identity WHERE key = ?");
  const auto value = [&](std::string_view key) {
    select.bind(1, key);
    if (!select.step()) throw damaged_store(path, "it lacks its " + std::string(key));
    std::string text = select.text(0);
    select.reset();
    return text;
  };
  SweepIdentity identity{.command = value("command"),
                         .title = value("title"),
                         .case_file = value("case_file"),
                         .case_sha256 = value("case_sha256"),
                         .overrides = text_list(value("overrides"), path),
                         .design = value("design"),
                         .seed = unsigned_number(value("seed"), path),
                         .columns = text_list(value("columns"), path),
                         .points = unsigned_number(value("points"), path),
                         .version = value("version"),
                         .commit = value("commit"),
                         .isa = value("isa")};
  return identity;
}

std::string identity_difference(const SweepIdentity& stored, const SweepIdentity& wanted) {
  std::string text;
  const auto there = identity_fields(stored), now = identity_fields(wanted);
  for (std::size_t i = 0; i < there.size(); ++i)
    if (there[i].name != nullptr && there[i].value != now[i].value)
      text += fmt::format("{}{} is {} there and {} now", text.empty() ? "" : ", ", there[i].name,
                          excerpt(there[i].value, now[i].value), excerpt(now[i].value, there[i].value));
  return text;
}

void read_rows(Database& database, const std::string& path, StoredSweep& into) {
  const std::size_t points = into.identity.points, columns = into.identity.columns.size();
  require_memory(points, columns, path);
  into.known.assign(points, false);
  into.rows.assign(points * columns, std::numeric_limits<double>::quiet_NaN());
  Statement select(database, "SELECT point, numbers, checksum FROM rows");
  while (select.step()) {
    const std::int64_t point = select.number(0);
    const auto bytes = select.bytes(1);
    if (point < 0 || std::cmp_greater_equal(point, points) || bytes.size() != 8 * columns ||
        select.number(2) != checksum(static_cast<std::size_t>(point), bytes))
      throw damaged_store(path, fmt::format("the row of point {} is not what was written", point));
    const auto i = static_cast<std::size_t>(point);
    into.known[i] = true;
    numbers_of(bytes, {into.rows.data() + i * columns, columns});
  }
}

StoreActivity read_activity(Database& database, const std::string& path) {
  StoreActivity activity;
  activity.known = static_cast<std::size_t>(database.number("SELECT count(*) FROM rows"));
  activity.sessions = static_cast<std::size_t>(database.number("SELECT count(*) FROM sessions"));
  Statement last(database, "SELECT began, written, rows FROM sessions ORDER BY id DESC LIMIT 1");
  if (!last.step()) throw damaged_store(path, "it lacks its start time");
  activity.began = last.real(0);
  activity.written = last.real(1);
  activity.session_rows = static_cast<std::size_t>(last.number(2));
  return activity;
}

std::vector<unsigned char> bytes_of(std::span<const double> numbers) {
  std::vector<unsigned char> bytes;
  bytes.reserve(8 * numbers.size());
  for (const double value : numbers) {
    const auto bits = std::bit_cast<std::uint64_t>(value);
    for (unsigned shift = 0; shift < 64; shift += 8) bytes.push_back(static_cast<unsigned char>(bits >> shift & 0xff));
  }
  return bytes;
}

/// FNV-1a of 64 bits, over the point as eight bytes and the bytes of its row: detects changes by a failing disk.
std::int64_t checksum(std::size_t point, std::span<const unsigned char> bytes) {
  std::array<std::uint64_t, 8> number{};
  for (unsigned k = 0; k < 8; ++k) number[k] = static_cast<std::uint64_t>(point) >> (8 * k) & 0xff;
  return std::bit_cast<std::int64_t>(fnv1a(bytes, fnv1a(number)));
}

}  // namespace limcycle

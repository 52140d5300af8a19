#include <algorithm>
#include <type_traits>

#include "limcycle/cases/loader/data/mat_reader.hpp"
#include "limcycle/cases/loader/sections/parameters.hpp"
#include "limcycle/cases/loader/sections/sections.hpp"
#include "limcycle/models/diagram/linear_blocks.hpp"
#include "limcycle/models/linear/controllers.hpp"
#include "limcycle/models/linear/plants.hpp"

namespace limcycle::case_file {
namespace {

/// A key that a variable of a MAT-file may stand for.
struct MatrixKey {
  std::string key;
  bool flat;  ///< a list, not a matrix
};

template <class Owner>
void add_matrix_keys(std::vector<MatrixKey>& keys, std::string_view kind) {
  if (Owner::kind != kind) return;
  const auto& rows = rows_of<Owner>();
  const auto values = values_of(Owner{});
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const bool matrix = std::holds_alternative<Eigen::MatrixXd>(values[i]);
    const bool flat = std::holds_alternative<std::vector<double>>(values[i]) ||
                      std::holds_alternative<std::vector<std::complex<double>>>(values[i]);
    const bool known = std::ranges::any_of(keys, [&](const MatrixKey& one) { return one.key == rows[i].key; });
    const bool of_file = rows[i].key == "columns";
    if ((matrix || flat) && !known && !of_file) keys.push_back({std::string(rows[i].key), flat});
  }
}

template <class... Owner>
void add_matrix_keys(std::vector<MatrixKey>& keys, std::string_view kind, std::type_identity<std::variant<Owner...>>) {
  (add_matrix_keys<Owner>(keys, kind), ...);
}

/// Those of the plants, controllers and blocks of this kind.
std::vector<MatrixKey> matrix_keys(std::string_view kind) {
  std::vector<MatrixKey> keys;
  add_matrix_keys(keys, kind, std::type_identity<Plant>{});
  add_matrix_keys(keys, kind, std::type_identity<Controller>{});
  add_matrix_keys<StateSpaceBlock>(keys, kind);
  return keys;
}

/// The matrices of a plant or controller in the place of the file; those that the case gives stay.
MatrixFile read_matrix_file(const Document& document, Value& part, const std::string& path,
                            const std::vector<MatrixKey>& keys) {
  const Section section(document, part, path);
  const Place file_key = section.at("file", "a MAT-file");
  const MatReader mat(section);
  MatrixFile taken{.path = path, .file = read_string(file_key), .sha256 = mat.sha256(), .variables = {}};
  Value::Table found;
  std::vector<std::string> wanted;
  for (const auto& [key, flat] : keys) {
    wanted.push_back(key);
    if (section.find(key) || std::ranges::find(mat.names(), key) == mat.names().end()) continue;
    found.push_back({key, mat.read(key, flat, key == points_of_data ? longest_data : longest_list)});
    taken.variables.push_back(key);
  }
  if (found.empty())
    throw file_key.error("holds none of the variables " + joined(wanted) + " that the case lacks; it holds " +
                         joined(mat.names()));
  auto& table = std::get<Value::Table>(part.data);
  std::erase_if(table, [](const Value::Entry& entry) { return entry.key == "file"; });
  std::ranges::move(found, std::back_inserter(table));
  return taken;
}

}  // namespace

std::vector<MatrixFile> read_matrices(Document& document) {
  std::vector<MatrixFile> files;
  for_each_part(document, [&](Value& part, const std::string& path) {
    const auto *kind = part.text("kind"), *file = part.text("file");
    if (kind == nullptr || file == nullptr) return;
    if (*kind == MeasuredPlant::kind && !file->ends_with(".mat")) return;  // a file of columns
    if (const auto keys = matrix_keys(*kind); !keys.empty())
      files.push_back(read_matrix_file(document, part, path, keys));
  });
  return files;
}

}  // namespace limcycle::case_file

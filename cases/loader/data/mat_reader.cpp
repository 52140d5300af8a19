#include "limcycle/cases/loader/data/mat_reader.hpp"

#include <hdf5.h>
#include <matio.h>

#include <cmath>
#include <span>

#include "limcycle/cases/loader/data/data_file.hpp"
#include "limcycle/cases/loader/sections/parameters.hpp"

namespace limcycle::case_file {
namespace {

/// Real and imaginary parts of a variable, columns after one another.
struct MatNumbers {
  std::span<const double> real, imaginary;
  std::size_t rows = 0, columns = 0;
};

std::optional<MatNumbers> numbers_of(const matvar_t& found) {
  if (found.class_type != MAT_C_DOUBLE || found.data_type != MAT_T_DOUBLE || found.rank != 2) return std::nullopt;
  MatNumbers numbers;
  numbers.rows = found.dims[0];
  numbers.columns = found.dims[1];
  const std::size_t count = numbers.rows * numbers.columns;
  if (count > 0 && found.data == nullptr) return std::nullopt;
  if (count == 0) return numbers;
  if (found.isComplex != 0) {
    const auto* parts = static_cast<const mat_complex_split_t*>(found.data);
    numbers.real = {static_cast<const double*>(parts->Re), count};
    numbers.imaginary = {static_cast<const double*>(parts->Im), count};
  } else {
    numbers.real = {static_cast<const double*>(found.data), count};
  }
  return numbers;
}

}  // namespace

MatReader::MatReader(const Section& section) : key_(section.at("file", "a MAT-file")) {
  const std::string name = read_string(key_);
  file_ = path_of_data(section, name);
  sha256_ = digest_of_data(file_, [&](const std::string& rule) { return error(rule); });
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // files of version 7.3 are HDF5, which prints what is wrong with them
  open_ = std::shared_ptr<mat_t>(Mat_Open(file_.c_str(), MAT_ACC_RDONLY), [](mat_t* file) {
    if (file != nullptr) Mat_Close(file);
  });
  auto* file = static_cast<mat_t*>(open_.get());
  std::size_t count = 0;
  char* const* const names = file != nullptr ? Mat_GetDir(file, &count) : nullptr;  // older versions return char**
  if (names == nullptr || count == 0)
    throw error("is no MAT-file with variables: save('" + name + "', 'A', 'B', 'C') writes one");
  for (std::size_t i = 0; i < count; ++i)
    if (names[i] != nullptr) names_.emplace_back(names[i]);
}

InputError MatReader::error(const std::string& what) const { return key_.error(what); }

Value MatReader::read(const std::string& name, bool flat, std::size_t most_rows) const {
  const std::unique_ptr<matvar_t, void (*)(matvar_t*)> found(
      Mat_VarRead(static_cast<mat_t*>(open_.get()), name.c_str()), Mat_VarFree);
  const auto numbers = found ? numbers_of(*found) : std::nullopt;
  const std::string variable = "holds the variable " + name + ", which ";
  if (!numbers) throw error(variable + "is no full matrix of the class double: save double(full(" + name + "))");
  const auto [real, imaginary, rows, columns] = *numbers;
  if (rows > most_rows || columns > longest_list)
    throw error(variable + "has more than " + std::to_string(rows > most_rows ? most_rows : longest_list) +
                (rows > most_rows ? " rows" : " columns"));
  for (const auto part : {real, imaginary})
    for (const double value : part)
      if (!std::isfinite(value)) throw error(variable + "has an element that is not finite");
  if (!flat && !imaginary.empty()) throw error(variable + "is complex: matrices are real");
  if (flat && rows > 1 && columns > 1) throw error(variable + "must be a row or a column");
  const auto here = [&](auto data) { return Value{std::move(data), key_.value.line, key_.value.override}; };
  Value::List outer;
  if (flat) {
    for (std::size_t i = 0; i < real.size(); ++i)
      outer.push_back(imaginary.empty() ? here(real[i]) : here(Value::List{here(real[i]), here(imaginary[i])}));
    return here(std::move(outer));
  }
  for (std::size_t i = 0; i < rows; ++i) {
    Value::List row;
    for (std::size_t j = 0; j < columns; ++j) row.push_back(here(real[i + j * rows]));
    outer.push_back(here(std::move(row)));
  }
  return here(std::move(outer));
}

}  // namespace limcycle::case_file

#pragma once
#include <string>
#include <string_view>

namespace limcycle {

/// The bytes of an HDF5 file that holds a JSON document of this program, in the same order, units and names:
///
/// - an object is a group; a list of objects a group with a column a key, whose first dimension is the list's; its
///   attribute `rows` is the length;
/// - a number, true, false and null are float64, 1 and 0 for true and false, NaN for null; larger integers than this
///   can hold are uint64;
/// - a text is ASCII, or UTF-8 where that is not enough, of fixed length, padded with zeros; null among texts is empty;
/// - a list of these, or of lists, is a dataset, the missing ends of unequal lists NaN or empty; but a list of lists of
///   texts, and lists of objects within a list of objects, are groups with the members 0, 1, ..., one a list.
///
/// The same document gives the same bytes (no time stamps). Memory: some three times the document. Throws
/// std::invalid_argument for text that is no JSON object, std::runtime_error if the HDF5 library fails.
std::string hdf5_document(std::string_view json);

}  // namespace limcycle

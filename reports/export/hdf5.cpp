#include "limcycle/reports/export/hdf5.hpp"

#include <hdf5.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

#include "limcycle/reports/format/json_values.hpp"

namespace limcycle {
namespace {

[[noreturn]] void failed(const std::string& what) { throw std::runtime_error("HDF5: cannot " + what); }

/// An identifier of the HDF5 library, closed at the end.
class Hdf5Id {
 public:
  Hdf5Id(hid_t id, herr_t (*close)(hid_t), const std::string& what) : id_(id), close_(close) {
    if (id < 0) failed(what);
  }
  Hdf5Id(Hdf5Id&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  ~Hdf5Id() {
    if (id_ >= 0) close_(id_);
  }
  Hdf5Id(const Hdf5Id&) = delete;
  Hdf5Id& operator=(const Hdf5Id&) = delete;
  Hdf5Id& operator=(Hdf5Id&&) = delete;
  operator hid_t() const { return id_; }  // NOLINT(google-explicit-constructor): every call of the library takes it

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

void need_done(herr_t code, const std::string& what) {
  if (code < 0) failed(what);
}

/// Values of the JSON document that stand in one dataset or group: one, or those of a list in the order of `sizes`
/// (the last varies fastest). A null pointer is a value that is not there.
struct HdfCells {
  std::vector<const Json*> values;
  std::vector<hsize_t> sizes;  ///< empty: one value
};

bool is_there(const Json* value) { return value != nullptr && !value->is_null(); }

template <class Test>
bool any(const HdfCells& cells, Test&& test) {
  return std::ranges::any_of(cells.values, [&](const Json* value) { return is_there(value) && test(*value); });
}

/// A list of objects, or of lists of them: its rows are groups.
bool holds_objects(const Json& list) {
  return list.is_array() &&
         std::ranges::any_of(list, [](const Json& one) { return one.is_object() || holds_objects(one); });
}

/// The elements of lists, all as long as the longest.
HdfCells opened(const HdfCells& lists) {
  HdfCells out;
  std::size_t longest = 0;
  for (const Json* list : lists.values)
    if (is_there(list)) longest = std::max(longest, list->is_array() ? list->size() : 1);
  out.sizes = lists.sizes;
  out.sizes.push_back(longest);
  out.values.reserve(lists.values.size() * longest);
  for (const Json* list : lists.values)
    for (std::size_t i = 0; i < longest; ++i) {
      if (!is_there(list))
        out.values.push_back(nullptr);
      else if (list->is_array())
        out.values.push_back(i < list->size() ? &(*list)[i] : nullptr);
      else
        out.values.push_back(i == 0 ? list : nullptr);
    }
  return out;
}

/// A name that HDF5 takes for one name.
std::string name_of(std::string key) {
  std::ranges::replace(key, '/', '_');
  return key.empty() || key == "." ? "_" : key;
}

class Hdf5Writer {
 public:
  Hdf5Writer()
      : keep_order_(H5Pcreate(H5P_GROUP_CREATE), H5Pclose, "make a property list"),
        without_times_(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "make a property list") {
    need_done(H5Pset_link_creation_order(keep_order_, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED), "keep an order");
    need_done(H5Pset_obj_track_times(without_times_, false), "leave out time stamps");
    need_done(H5Pset_obj_track_times(keep_order_, false), "leave out time stamps");
  }

  /// Writes the members of an object, or columns of several, into a group.
  void members(hid_t group, const HdfCells& objects) {
    std::vector<std::string> keys;
    for (const Json* object : objects.values)
      if (is_there(object))
        for (const auto& [key, value] : object->items())
          if (std::ranges::find(keys, key) == keys.end()) keys.push_back(key);
    for (const std::string& key : keys) {
      HdfCells column{.values = {}, .sizes = objects.sizes};
      column.values.reserve(objects.values.size());
      for (const Json* object : objects.values) {
        const auto found = is_there(object) ? object->find(key) : Json::const_iterator();
        column.values.push_back(is_there(object) && found != object->end() ? &*found : nullptr);
      }
      add(group, name_of(key), column);
    }
  }

 private:
  void add(hid_t parent, const std::string& name, const HdfCells& cells) {
    if (any(cells, [](const Json& one) { return one.is_object(); })) {
      members(new_group(parent, name), cells);
    } else if (any(cells, holds_objects)) {
      add_rows(parent, name, cells);
    } else if (any(cells, [](const Json& one) { return one.is_array(); })) {
      add(parent, name, opened(cells));
    } else if (any(cells, [](const Json& one) { return one.is_string(); })) {
      add_texts(parent, name, cells);
    } else {
      add_numbers(parent, name, cells);
    }
  }

  /// Lists of objects: one as columns, several as one group each.
  void add_rows(hid_t parent, const std::string& name, const HdfCells& lists) {
    const Hdf5Id group = new_group(parent, name);
    if (lists.sizes.empty()) {
      const HdfCells rows = opened(lists);
      note_rows(group, rows.values.size());
      members(group, rows);
      return;
    }
    for (std::size_t i = 0; i < lists.values.size(); ++i) {
      const HdfCells one{.values = {lists.values[i]}, .sizes = {}};
      if (is_there(lists.values[i]) && holds_objects(*lists.values[i]))
        add_rows(group, std::to_string(i), one);
      else
        note_rows(new_group(group, std::to_string(i)), 0);
    }
  }

  Hdf5Id new_group(hid_t parent, const std::string& name) const {
    return {H5Gcreate2(parent, name.c_str(), H5P_DEFAULT, keep_order_, H5P_DEFAULT), H5Gclose,
            "make the group " + name};
  }

  static void note_rows(hid_t group, std::size_t rows) {
    const Hdf5Id space(H5Screate(H5S_SCALAR), H5Sclose, "make a scalar");
    const Hdf5Id attribute(H5Acreate2(group, "rows", H5T_STD_U64LE, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
                           "make the attribute rows");
    const std::uint64_t value = rows;
    need_done(H5Awrite(attribute, H5T_NATIVE_UINT64, &value), "write the attribute rows");
  }

  void dataset(hid_t parent, const std::string& name, const HdfCells& cells, hid_t in_file, hid_t in_memory,
               const void* values) const {
    const Hdf5Id space(cells.sizes.empty()
                           ? H5Screate(H5S_SCALAR)
                           : H5Screate_simple(static_cast<int>(cells.sizes.size()), cells.sizes.data(), nullptr),
                       H5Sclose, "make room for " + name);
    const Hdf5Id data(H5Dcreate2(parent, name.c_str(), in_file, space, H5P_DEFAULT, without_times_, H5P_DEFAULT),
                      H5Dclose, "make the dataset " + name);
    if (!cells.values.empty())
      need_done(H5Dwrite(data, in_memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), "write the dataset " + name);
  }

  void add_numbers(hid_t parent, const std::string& name, const HdfCells& cells) const {
    // Seeds may need all 64 bits.
    constexpr std::uint64_t exact = std::uint64_t{1} << std::numeric_limits<double>::digits;
    if (any(cells, [](const Json& one) { return one.is_number_unsigned() && one.get<std::uint64_t>() > exact; })) {
      std::vector<std::uint64_t> whole;
      for (const Json* value : cells.values) whole.push_back(is_there(value) ? value->get<std::uint64_t>() : 0U);
      dataset(parent, name, cells, H5T_STD_U64LE, H5T_NATIVE_UINT64, whole.data());
      return;
    }
    std::vector<double> numbers;
    numbers.reserve(cells.values.size());
    for (const Json* value : cells.values)
      numbers.push_back(!is_there(value)      ? NAN
                        : value->is_boolean() ? (value->get<bool>() ? 1.0 : 0.0)
                                              : value->get<double>());
    dataset(parent, name, cells, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, numbers.data());
  }

  void add_texts(hid_t parent, const std::string& name, const HdfCells& cells) const {
    if (cells.sizes.size() > 1) return add_text_lists(parent, name, cells);
    std::vector<std::string> texts;
    std::size_t longest = 1;
    for (const Json* value : cells.values) {
      texts.push_back(!is_there(value) ? "" : value->is_string() ? value->get<std::string>() : json_text(*value));
      longest = std::max(longest, texts.back().size());
    }
    std::string padded;
    for (std::string& text : texts) padded.append(text).append(longest - text.size(), '\0');
    const Hdf5Id type(H5Tcopy(H5T_C_S1), H5Tclose, "make a type of text");
    need_done(H5Tset_size(type, longest), "make a type of text");
    // Octave reads no other.
    const bool ascii = std::ranges::all_of(padded, [](char c) { return static_cast<unsigned char>(c) < 0x80; });
    need_done(H5Tset_cset(type, ascii ? H5T_CSET_ASCII : H5T_CSET_UTF8), "make a type of text");
    need_done(H5Tset_strpad(type, H5T_STR_NULLPAD), "make a type of text");
    dataset(parent, name, cells, type, type, padded.data());
  }

  /// Octave reads no table of texts.
  void add_text_lists(hid_t parent, const std::string& name, const HdfCells& lists) const {
    const Hdf5Id group = new_group(parent, name);
    const std::size_t count = lists.sizes.front(), each = count > 0 ? lists.values.size() / count : 0;
    for (std::size_t i = 0; i < count; ++i) {
      const auto from = lists.values.begin() + static_cast<std::ptrdiff_t>(i * each);
      add_texts(group, std::to_string(i),
                {.values = {from, from + static_cast<std::ptrdiff_t>(each)},
                 .sizes = {lists.sizes.begin() + 1, lists.sizes.end()}});
    }
  }

  Hdf5Id keep_order_, without_times_;
};

/// A file in memory.
std::string image_of(const Json& top) {
  const Hdf5Id access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "make a property list");
  need_done(H5Pset_fapl_core(access, std::size_t{1} << 20U, false), "hold a file in memory");
  const Hdf5Id creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose, "make a property list");
  need_done(H5Pset_link_creation_order(creation, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED), "keep an order");
  need_done(H5Pset_obj_track_times(creation, false), "leave out time stamps");
  const Hdf5Id file(H5Fcreate("limcycle.h5", H5F_ACC_TRUNC, creation, access), H5Fclose, "make a file in memory");
  Hdf5Writer().members(file, {.values = {&top}, .sizes = {}});
  need_done(H5Fflush(file, H5F_SCOPE_GLOBAL), "complete the file");
  const ssize_t size = H5Fget_file_image(file, nullptr, 0);
  std::string bytes(size > 0 ? static_cast<std::size_t>(size) : 0U, '\0');
  if (size <= 0 || H5Fget_file_image(file, bytes.data(), bytes.size()) < 0) failed("take the file out of memory");
  return bytes;
}

}  // namespace

std::string hdf5_document(std::string_view json) {
  const Json top = Json::parse(json, nullptr, false);
  if (!top.is_object()) throw std::invalid_argument("HDF5: the document is no JSON object");
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // what fails is thrown
  return image_of(top);
}

}  // namespace limcycle

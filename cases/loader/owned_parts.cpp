#include "limcycle/cases/loader/owned_parts.hpp"

#include <type_traits>

namespace limcycle::case_file {
namespace {

const std::vector<ParameterRow>& rows_in(const Element& element) { return element.parameters(); }
std::vector<ParameterValue> values_in(const Element& element) { return element.values(); }
void write(Element& element, const std::vector<ParameterValue>& values) { element = element.with(values); }

template <class... Kinds>
const std::vector<ParameterRow>& rows_in(const std::variant<Kinds...>& any) {
  return std::visit(
      []<class Owner>(const Owner& owner) -> const std::vector<ParameterRow>& {
        if constexpr (requires { Owner::parameters(); })
          return rows_of<Owner>();
        else
          return rows_in(owner);
      },
      any);
}

template <class... Kinds>
std::vector<ParameterValue> values_in(const std::variant<Kinds...>& any) {
  return std::visit(
      []<class Owner>(const Owner& owner) {
        if constexpr (requires { Owner::parameters(); })
          return values_of(owner);
        else
          return values_in(owner);
      },
      any);
}

template <class... Kinds>
void write(std::variant<Kinds...>& any, const std::vector<ParameterValue>& values) {
  std::visit(
      [&]<class Owner>(Owner& owner) {
        if constexpr (requires { Owner::parameters(); })
          set_values(owner, values);
        else
          write(owner, values);
      },
      any);
}

bool is_valid(const Element& element) { return !element.validate(); }
template <class... Kinds>
bool is_valid(const std::variant<Kinds...>& any) {
  return std::visit(
      []<class Owner>(const Owner& owner) {
        if constexpr (requires { Owner::parameters(); })
          return !owner.validate();
        else
          return is_valid(owner);
      },
      any);
}

/// The part that `find` finds in the parts of a loop, constant or not.
template <class Find>
OwnedPart part(std::string section, Find find) {
  return {std::move(section),
          [find](const LoopParts& parts) -> const std::vector<ParameterRow>& { return rows_in(find(parts)); },
          [find](const LoopParts& parts) { return values_in(find(parts)); },
          [find](LoopParts& parts, const std::vector<ParameterValue>& values) { write(find(parts), values); },
          [find](const LoopParts& parts) { return is_valid(find(parts)); }};
}

}  // namespace

bool is_elsewhere(const OwnedPart& part, std::string_view key) {
  if (key == "order" || key == "averages") return true;  // of a measured plant: how its data are read and fitted
  return part.section.starts_with("diagram.") && key == "friction_compensation";
}

std::vector<OwnedPart> owned_parts(const LoopParts& parts) {
  std::vector<OwnedPart> list;
  if (parts.diagram) {
    const auto& blocks = parts.diagram->blocks;
    for (std::size_t i = 0; i < blocks.size(); ++i)
      list.push_back(part(
          blocks[i].path, [i](auto& of) -> auto& { return of.diagram->blocks[i].what; }));
    return list;
  }
  list.push_back(part(
      "loop.plant", [](auto& of) -> auto& { return of.plant; }));
  list.push_back(part(
      "loop.controller", [](auto& of) -> auto& { return of.controller; }));
  if (parts.friction)
    list.push_back(part(
        "loop.friction", [](auto& of) -> auto& { return *of.friction; }));
  if (parts.element)
    list.push_back(part(
        "loop.element", [](auto& of) -> auto& { return *of.element; }));
  if (parts.error)
    list.push_back(part(
        "loop.error", [](auto& of) -> auto& { return *of.error; }));
  return list;
}

}  // namespace limcycle::case_file

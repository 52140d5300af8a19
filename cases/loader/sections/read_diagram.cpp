#include <algorithm>

#include "limcycle/cases/loader/sections/parameters.hpp"
#include "limcycle/cases/loader/sections/sections.hpp"
#include "limcycle/cases/loader/signal_sum.hpp"
#include "limcycle/models/element/of_controllers/compensation.hpp"

namespace limcycle::case_file {
namespace {

using Keys = std::vector<std::string>;

const std::string compensation_kind(Compensation<double>::kind);
const KindNames block_names{.what = "block", .elsewhere = {}, .elsewhere_hint = {}};

/// Kinds of blocks besides friction laws and elements, each once.
std::vector<std::string> linear_kinds() {
  std::vector<std::string> all = kinds_of<Plant>();
  for (const auto& kind : kinds_of<LinearBlock>()) all.push_back(kind);
  all.emplace_back(Pid::kind);
  std::ranges::sort(all);
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

std::vector<Element> elements_in_a_path() {
  std::vector<Element> all = catalogue_of_elements().series_elements;
  for (const Element& element : catalogue_of_elements().error_elements)
    if (find_kind(all, element.kind()) == nullptr) all.push_back(element);
  return all;
}

template <class Kind>
bool has_kind(const std::string& kind) {
  const auto kinds = kinds_of<Kind>();
  return std::ranges::find(kinds, kind) != kinds.end();
}

Keys with(Keys keys, const Keys& more) {
  keys.insert(keys.end(), more.begin(), more.end());
  return keys;
}

Keys clock_keys() {
  const auto& rows = rows_of<BlockSampling>();
  Keys keys;
  keys.reserve(rows.size());
  for (const ParameterRow& row : rows) keys.emplace_back(row.key);
  return keys;
}

/// True for linear blocks that may run on a computer: those with one input, one output and a response of their own.
bool may_be_sampled(const BlockKind& what) {
  const auto* linear = std::get_if<LinearBlock>(&what);
  return linear != nullptr && !std::holds_alternative<SumBlock>(*linear) &&
         !std::holds_alternative<Constant>(*linear) && !std::holds_alternative<DelayBlock>(*linear) &&
         !std::holds_alternative<StateSpaceBlock>(*linear);
}

/// Reads the keys of a block that runs on a computer, if there are any.
void read_sampling(const Section& section, Block& block) {
  const Keys keys = clock_keys();
  const auto first = std::ranges::find_if(keys, [&](const std::string& key) { return section.find(key).has_value(); });
  if (first == keys.end()) return;
  if (!may_be_sampled(block.what)) throw section.error(*first, "is not for this kind of block");
  Keys others;
  for (const auto& entry : section.table())
    if (std::ranges::find(keys, entry.key) == keys.end()) others.push_back(entry.key);
  block.sampling = read_owner<BlockSampling>(section, others);
}

/// A strictly proper transfer function is a plant, on which friction may act; a proper one passes its input straight
/// on.
BlockKind read_transfer_function(const Section& section, const Keys& keys) {
  TransferFunction plant;
  set_values(plant, read_values(section, rows_of<TransferFunction>(), values_of(plant), keys));
  if (!section.find("sample_time") && !plant.validate()) return Plant(plant);
  if (section.find("sample_time") && plant.delay > 0.0)
    throw section.error("delay", "cannot stand beside sample_time: let it be a block of its own");
  const ProperTransferFunction proper{plant.numerator, plant.denominator};
  if (const auto broken = proper.validate())
    throw broken_rule(section, *broken, rows_of<ProperTransferFunction>(), values_of(proper));
  if (plant.delay > 0.0) throw section.error("delay", "needs a lower degree of the numerator than of the denominator");
  return LinearBlock(proper);
}

/// A state space of one input and one output without feed-through is a plant, on which friction may act.
BlockKind read_state_space(const Section& section, const Keys& keys) {
  StateSpacePlant plant;
  const auto values = read_values(section, rows_of<StateSpacePlant>(), values_of(plant), keys);
  set_values(plant, values);
  if (plant.B.cols() == 1 && plant.C.rows() == 1 && plant.D.isZero(0.0)) {
    if (const auto broken = plant.validate()) throw broken_rule(section, *broken, rows_of<StateSpacePlant>(), values);
    return Plant(plant);
  }
  for (const char* key : {"B_friction", "C_velocity", "C_friction"})
    if (section.find(key))
      throw section.error(key, "needs a state space of one input and one output without feed-through");
  const StateSpaceBlock block{plant.A, plant.B, plant.C, plant.D};
  if (const auto broken = block.validate())
    throw broken_rule(section, *broken, rows_of<StateSpaceBlock>(), values_of(block));
  return LinearBlock(block);
}

Pid read_pid(const Section& section, const Keys& keys) {
  const Pid pid = read_owner<Pid>(section, keys);
  if (pid.friction_compensation > 0.0)
    throw section.error("friction_compensation", "is a block of its own in a diagram",
                        "kind = \"friction-compensation\", on = the plant; add its output to the command");
  return pid;
}

/// Friction law or compensation at a body.
void read_contact(const Section& section, const std::string& kind, Block& block) {
  const Keys keys{"name", "on", "between"};
  if (kind == compensation_kind) {
    block.contact = Contact::senses;
    Keys all = keys;
    all.emplace_back("kind");
    block.what = Element(read_owner<Compensation<double>>(section, all));
  } else {
    block.contact = Contact::opposes;
    block.what = read_element(section, catalogue_of_elements().friction_laws,
                              {.what = "friction law",
                               .elsewhere = limcycle::kinds_of(catalogue_of_elements().forward_elements),
                               .elsewhere_hint = "does not act on a body: it needs `input` in place of `on`"},
                              keys);
  }
  const auto on = section.find("on"), between = section.find("between");
  if (on && between) throw between->error("cannot stand beside `on`: friction acts on one body or between two");
  if (on) {
    block.on = read_string(*on);
    return;
  }
  const auto* bodies = between->value.as<Value::List>();
  if (bodies == nullptr || bodies->size() != 2) throw between->error("must be the names of two bodies");
  block.on = read_string(between->item(0));
  block.against = read_string(between->item(1));
}

void read_inputs(const Section& section, Block& block) {
  const std::size_t count = inputs_of(block);
  if (count == 0) return;
  const Place place = section.at("input", "the signal that goes into the block, such as \"r - axis.y\"");
  if (const auto* list = place.value.as<Value::List>()) {
    for (std::size_t i = 0; i < list->size(); ++i) block.inputs.push_back(read_signal_sum(place.item(i)));
  } else {
    block.inputs.push_back(read_signal_sum(place));
  }
  if (block.inputs.size() != count)
    throw place.error("must be " + std::to_string(count) + (count == 1 ? " signal" : " signals in a list") +
                      ": the block has as many inputs");
}

Block read_block(const Section& section, const std::string& name) {
  Block block{name, section.path(), LinearBlock(SumBlock{})};
  auto known = linear_kinds();
  const auto elements = elements_in_a_path();
  for (const auto& kind : limcycle::kinds_of(elements)) known.push_back(kind);
  known.push_back(compensation_kind);
  const NamedKind named = read_kind(section, known, block_names);
  const std::string& kind = named.kind;
  if (std::ranges::find(known, kind) == known.end()) throw unknown_kind(named.place, known, block_names);
  if (section.find("on") || section.find("between")) {
    read_contact(section, kind, block);
    return block;
  }
  if (kind == compensation_kind) throw section.error("on", "is required: the plant whose velocity is compensated");
  if (!section.find("input") && find_kind(catalogue_of_elements().friction_laws, kind) != nullptr)
    throw section.error("on",
                        "is required: the body that friction acts on (or between = [...] for two bodies, or input "
                        "for a law in the path of a signal)");
  const Keys signal_keys = kind == Constant::kind ? Keys{"name"} : Keys{"name", "input"};
  const Keys keys = with({"kind"}, signal_keys);
  if (kind == TransferFunction::kind)
    block.what = read_transfer_function(section, with(keys, clock_keys()));
  else if (kind == StateSpacePlant::kind)
    block.what = read_state_space(section, keys);
  else if (has_kind<Plant>(kind))
    block.what = read_any<Plant>(section, block_names, signal_keys);
  else if (kind == Pid::kind)
    block.what = Controller(read_pid(section, keys));
  else if (has_kind<LinearBlock>(kind))
    block.what = read_any<LinearBlock>(section, block_names, with(signal_keys, clock_keys()));
  else
    block.what = read_element(section, elements, block_names, signal_keys);
  if (kind != Pid::kind) read_sampling(section, block);
  read_inputs(section, block);
  return block;
}

std::vector<std::string> names_in(const Diagram& diagram) {
  std::vector<std::string> names{"r"};
  for (const Block& block : diagram.blocks) names.push_back(block.name);
  return names;
}

/// Throws if a block that is named does not exist.
void check_name(const Section& section, const Diagram& diagram, const std::string& key, const std::string& name,
                bool may_be_reference) {
  if ((may_be_reference && name == "r") || find_block(diagram, name)) return;
  auto known = names_in(diagram);
  if (!may_be_reference) known.erase(known.begin());
  throw section.error(key, "there is no block \"" + name + "\"", suggest(name, known));
}

void check_names(const Section& section, const Diagram& diagram) {
  check_name(section, diagram, "output", diagram.output.block, false);
  for (const Block& block : diagram.blocks) {
    const Section one = section.section(block.name).value();
    for (const SignalSum& sum : block.inputs)
      for (const Term& term : sum) check_name(one, diagram, "input", term.block, true);
    const std::string key = block.against.empty() ? "on" : "between";
    if (!block.on.empty()) check_name(one, diagram, key, block.on, false);
    if (!block.against.empty()) check_name(one, diagram, key, block.against, false);
    if (block.on == block.against && !block.on.empty()) throw one.error(key, "must be two different bodies");
  }
}

/// Throws for a block whose output nothing but itself reads: a wire was forgotten, or the block.
void check_all_are_read(const Section& section, const Diagram& diagram) {
  for (const Block& block : diagram.blocks) {
    const auto reads = [&](const Block& other) {
      if (other.on == block.name || other.against == block.name) return true;
      if (&other == &block) return false;
      return std::ranges::any_of(other.inputs, [&](const SignalSum& sum) {
        return std::ranges::find(sum, block.name, &Term::block) != sum.end();
      });
    };
    if (block.contact == Contact::opposes || diagram.output.block == block.name) continue;
    if (!std::ranges::any_of(diagram.blocks, reads))
      throw section.section(block.name)->error("name", "nothing reads the output of this block: join it or remove it");
  }
}

/// The plant on which an external force acts: that of the output, else the first one.
std::string loaded(const Diagram& diagram) {
  const auto is_plant = [](const Block& block) { return std::holds_alternative<Plant>(block.what); };
  const auto found = find_block(diagram, diagram.output.block);
  if (found && is_plant(diagram.blocks[*found])) return diagram.output.block;
  const auto first = std::ranges::find_if(diagram.blocks, is_plant);
  return first == diagram.blocks.end() ? std::string() : first->name;
}

}  // namespace

void read_diagram(const Section& section, Case& into) {
  LoopParts parts;
  Diagram& diagram = parts.diagram.emplace();
  for (const auto& [name, value] : section.table()) {
    if (name == "output" || name == "reference") continue;
    if (value.as<Value::Table>() == nullptr || value.find("name") == nullptr)
      throw section.error(name, "unknown key", "a block begins with [[diagram.block]] and its name");
    diagram.blocks.push_back(read_block(section.section(name).value(), name));
  }
  if (diagram.blocks.empty()) throw section.error("block", "is required: a diagram needs [[diagram.block]]");
  const Place output = section.at("output", "the signal that is y, such as \"axis.y\"");
  const SignalSum sum = read_signal_sum(output);
  if (sum.size() != 1 || sum.front().factor != 1.0) throw output.error("must be one signal, such as \"axis.y\"");
  diagram.output = sum.front();
  if (const auto reference = section.find("reference")) read_reference(*reference, parts);
  check_names(section, diagram);
  check_all_are_read(section, diagram);
  diagram.load_on = loaded(diagram);
  check_together(section, "diagram", parts);
  into.element_path = subject_of(parts).path;
  into.loop = std::move(parts);
}

}  // namespace limcycle::case_file

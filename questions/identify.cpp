#include "limcycle/questions/identify.hpp"

#include <stdexcept>

#include "limcycle/questions/asking/answer_of.hpp"
#include "limcycle/reports/identify/identify.hpp"

namespace limcycle {

IdentifyReport ask_identify(const Case& from, bool plan, const Asking& asking) {
  IdentifyOptions options;
  options.stop = asking.stop;
  options.progress = asking.progress;
  IdentifyRequest request = identify_request(from);
  request.plan = plan;
  try {
    return identify(request, options);
  } catch (const std::invalid_argument& unusable) {
    throw InputError({.file = from.file,
                      .line = 0,
                      .override = {},
                      .key = "identify",
                      .value = {},
                      .rule = unusable.what(),
                      .suggestion = {}});
  }
}

std::string fitted_text(const Case& from, const IdentifyReport& report, const std::string& file) {
  if (!report.chosen) throw NoAnswer("no law was chosen, so that there is no fitted case to write");
  try {
    std::string text = fitted_case(from.text, from.title, report.laws[*report.chosen]);
    read_case(text, file);
    return text;
  } catch (const InputError& error) {
    throw NoAnswer("the fitted law does not make a valid case in " + file + ": " + std::string(error.what()));
  } catch (const std::invalid_argument& error) {
    throw NoAnswer(error.what());
  }
}

}  // namespace limcycle

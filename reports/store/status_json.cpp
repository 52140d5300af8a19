#include "limcycle/reports/document_header.hpp"
#include "limcycle/reports/format/json_values.hpp"
#include "limcycle/reports/store/status.hpp"

namespace limcycle {

std::string status_json(const Provenance& provenance, const std::string& file, const StoredSweep& sweep) {
  const SweepIdentity& identity = sweep.identity;
  const StoreActivity& activity = sweep.activity;
  Provenance made = provenance;
  made.title = identity.title;
  made.file = identity.case_file;
  made.sha256 = identity.case_sha256;
  made.overrides = identity.overrides;
  made.seed = identity.seed;
  made.isa = identity.isa;
  Json columns = Json::array();
  for (const auto& column : column_summaries(sweep))
    columns.push_back({{"column", column.name},
                       {"finite", column.finite},
                       {"minimum", number(column.minimum)},
                       {"mean", number(column.mean)},
                       {"maximum", number(column.maximum)}});
  const Json body{{"store", file},
                  {"sweep",
                   {{"command", identity.command},
                    {"design", identity.design},
                    {"version", identity.version},
                    {"commit", identity.commit}}},
                  {"points", identity.points},
                  {"known", activity.known},
                  {"running", activity.running},
                  {"process", activity.pid > 0 ? Json(activity.pid) : Json(nullptr)},
                  {"sessions", activity.sessions},
                  {"session_points", activity.session_rows},
                  {"began", number(activity.began)},
                  {"written", number(activity.written)},
                  {"rate", activity.rate() > 0.0 ? number(activity.rate()) : Json(nullptr)},
                  {"seconds_left", number(seconds_left(sweep))},
                  {"columns", columns}};
  return json_document("status", made, json_text(body));
}

}  // namespace limcycle

#include "limcycle/questions/predict.hpp"

namespace limcycle {

PredictReport ask_predict(const Case& from, const Asking& asking) {
  PredictOptions options = from.predict;
  options.stop = asking.stop;
  options.progress = asking.progress;
  return predict(build_loop(need_loop(from)), options);
}

}  // namespace limcycle

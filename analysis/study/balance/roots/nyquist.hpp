#pragma once
#include <functional>
#include <vector>

#include "limcycle/analysis/study/balance/first_harmonic_balance.hpp"
#include "limcycle/analysis/study/predict/predict.hpp"

namespace limcycle {

/// Both curves over the search box, finer where G turns fast; where an amplitude or frequency belongs to a root, the
/// curves have a point there. G is that of small motions: other elements of the loop, and gravity, change it with the
/// amplitude. Points where N or G does not exist are NaN or omitted. `stop` is called between points: when it returns
/// true the curves end there.
NyquistPicture nyquist_picture(const Loop& loop, const FirstHarmonicBalance& balance, const SearchBox& box,
                               const std::vector<SearchPoint>& roots = {}, const std::function<bool()>& stop = {});

/// The same for what predict() reports of the loop: over its search box, where there are data if a plant is measured,
/// with points at the roots of its describing function; empty if that does not exist or was not asked for. Cost: up to
/// 2,300 describing functions.
NyquistPicture nyquist_picture(const Loop& loop, const PredictReport& report, const std::function<bool()>& stop = {});

}  // namespace limcycle

#pragma once
#include <string>

namespace limcycle {

/// Shortest decimal text that reads back as the same double ("0.1", "1e-06"). Empty for NaN and infinities.
std::string shortest(double value);

/// Appends that text; for documents of many numbers.
void append_shortest(std::string& out, double value);

/// `digits` significant digits (1..17), plain or with an exponent, whichever is readable: plain for 1e-4 <= |value| <
/// 1e7.
/// "-" for NaN and infinities.
std::string with_digits(double value, int digits);

/// Prints the accurate digits only: the last one shown is in the decimal place of twice the error, so that it is off by
/// less than 6 units and all before it are right except for a carry. Between 2 and 12 significant digits.
/// `relative_error` is relative to `value`; 0 means exact, NaN or infinity means unknown (4 digits are shown).
std::string with_error(double value, double relative_error);

/// A number with an absolute error, such as a mean that is nearly zero: 0 if the error is larger.
std::string with_absolute_error(double value, double error);

/// An error estimate itself: two digits with an exponent ("1.2e-10"), "0" for zero.
std::string as_error(double value);

/// A share in per cent, three digits ("62.1 %"); a share that is not 0 or 1 is never printed as 0 % or 100 %.
std::string as_percent(double share);

/// A waiting time, rounded up: "12 s", "3 min 05 s", "2 h 04 min", "3 d 01 h"; "?" if it is not known.
std::string as_waiting_time(double seconds);

}  // namespace limcycle

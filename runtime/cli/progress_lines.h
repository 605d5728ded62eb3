// How far a command is, for whoever watches: one line of a terminal that changes; or lines of standard output
// that sessions of the Open Job Description read, "openjd_progress: 42.0" and "openjd_status: frame 12 of
// 60"; in a pipe nothing.
#pragma once

#include <string>

namespace fw::cli {

/// From now on it is said in lines for such a session.
void showProgressToOpenJd();

/// Whether anyone watches.
bool progressIsShown();

/// `percent` of 100; `rest`, behind what is done, is for a terminal alone. To a session progress never goes
/// back.
void showProgress(double percent, const std::string& doing, const std::string& rest = {});

/// Nothing is going on any more.
void hideProgress();

}  // namespace fw::cli

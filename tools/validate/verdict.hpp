// One line of `binpick validate`: what was measured, what it should be, and whether it is. Values are SI or pixels; the
// table for people shows lengths in mm and angles in degrees.
#pragma once

#include <string>
#include <vector>

namespace binpick {

struct Verdict {
  enum class Rule {
    kWithin,  ///< |value - expected| <= tolerance
    kAbove,   ///< value > expected - tolerance
    kBelow,   ///< value < expected + tolerance
    kReport   ///< no expectation: a number is all that is asked for
  };
  std::string id;    ///< number of the check in the reference, e.g. "V-A1"; several lines may share it
  std::string what;  ///< what was measured
  double value = 0, expected = 0;
  double tolerance = 0;  ///< absolute, in the same unit
  std::string unit;      ///< "m", "rad", "px", "m/m", or "1" for plain numbers and shares
  Rule rule = Rule::kWithin;
  int samples = 0;           ///< independent draws behind the value; 0 where there is nothing to count
  double low = 0, high = 0;  ///< 95 % interval of the value, when there are samples

  bool pass() const;  ///< never for a value that is not a number
};

bool all_pass(const std::vector<Verdict>& verdicts);

/// The table, one line a verdict, and a last line that counts them.
std::string table_of(const std::vector<Verdict>& verdicts);
/// [{"id","what","value","expected","tolerance","unit","rule","pass"}], and "samples","low","high" where draws were
/// counted; a value that is not a number is null.
std::string json_of(const std::vector<Verdict>& verdicts);

/// `line` with the mean of the values (finite ones and others alike) and its Student interval.
Verdict mean_line(Verdict line, const std::vector<double>& values);
/// `line` with hits / total and its Wilson interval.
Verdict share_line(Verdict line, std::size_t hits, std::size_t total);

/// Relative standard error of an RMS over `images` independent images of `pixels` pixels each, of Gaussian noise whose
/// autocorrelation is exp(-k^2 / (4 l^2)): a sum of squares over `pixels` has only pixels / (2 pi l^2) degrees of
/// freedom (white noise: pixels), and the RMS of n independent values is known to 1 / sqrt(2 n).
double rms_standard_error(int pixels, double correlation_length, int images);

/// The tolerance of a form that looks at fewer images than the full one: three times the growth of the standard error
/// on top, so that the short form rejects as rarely as the full one.
double widened(double tolerance, double error, double full_error);

}  // namespace binpick

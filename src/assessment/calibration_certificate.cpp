#include "spherical_actuator_calibration/assessment/calibration_certificate.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "si_units.hpp"
#include "spherical_actuator_calibration/assessment/calibration_grade.hpp"
#include "spherical_actuator_calibration/assessment/covariance_file.hpp"
#include "spherical_actuator_calibration/assessment/reported_covariance.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/input_file.hpp"
#include "spherical_actuator_calibration/base/number_text.hpp"
#include "spherical_actuator_calibration/base/printable_text.hpp"
#include "spherical_actuator_calibration/base/text_format.hpp"
#include "spherical_actuator_calibration/base/yaml_reader.hpp"
#include "spherical_actuator_calibration/estimation/distributions.hpp"

#include <tinyxml2.h>

namespace sac {
namespace {

constexpr char kNotStated[] = "not stated";
constexpr char kUnknownCountry[] = "ZZ";  // free for users in ISO 3166-1
constexpr char kCoverage[] = "0.95";

/// An element of XML that ends with the object.
class Element {
 public:
  Element(tinyxml2::XMLPrinter& printer, const char* name) : printer_(printer) {
    printer_.OpenElement(name);
  }
  ~Element() { printer_.CloseElement(); }
  Element(const Element&) = delete;
  Element& operator=(const Element&) = delete;
  Element(Element&&) = delete;
  Element& operator=(Element&&) = delete;

 private:
  tinyxml2::XMLPrinter& printer_;
};

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) {
    text += (text.empty() ? "" : " ") + word;
  }
  return text;
}

std::string numbers(const Eigen::VectorXd& values) {
  std::vector<std::string> words;
  words.reserve(static_cast<std::size_t>(values.size()));
  for (const double value : values) {
    words.push_back(shortestText(value));
  }
  return joined(words);
}

/// Without an exponent, as D-SI wants coverage factors.
std::string factorText(double factor) {
  return format("%.4f", factor);
}

class Certificate {
 public:
  Certificate(const CalibrationSession& session,
              const CalibrationOrigin& origin,
              const CertificateIssuer& issuer)
      : session_(session), origin_(origin), issuer_(issuer), graded_(gradeCalibration(session)) {
    const std::vector<ParameterEstimate> parameters = session.parameters();
    for (std::size_t p = 0; p < parameters.size(); ++p) {
      if (parameters[p].observable) {
        places_.push_back(static_cast<Eigen::Index>(p));
        results_.push_back(parameters[p]);
      } else {
        open_.push_back(parameters[p].name);
      }
    }
    if (results_.empty()) {
      throw DataError("A certificate needs results: no parameter is identified.");
    }
    covariance_ = reportedCovariance(session)(places_, places_);
  }

  std::string text() {
    printer_.PushHeader(false, true);
    printer_.OpenElement("dcc:digitalCalibrationCertificate");
    printer_.PushAttribute("xmlns:dcc", "https://ptb.de/dcc");
    printer_.PushAttribute("xmlns:si", "https://ptb.de/si");
    printer_.PushAttribute("xmlns:xsi", "http://www.w3.org/2001/XMLSchema-instance");
    printer_.PushAttribute("xsi:schemaLocation",
                           "https://ptb.de/dcc https://ptb.de/dcc/v3.3.0/dcc.xsd");
    printer_.PushAttribute("schemaVersion", "3.3.0");
    administrativeData();
    measurementResults();
    printer_.CloseElement();
    return printer_.CStr();
  }

 private:
  using Words = std::vector<std::string>;

  void leaf(const char* name, const std::string& text) {
    const Element element(printer_, name);
    printer_.PushText(text.c_str());
  }
  /// Text for people, in English.
  void content(const char* name, const Words& paragraphs) {
    const Element element(printer_, name);
    for (const std::string& paragraph : paragraphs) {
      const Element content(printer_, "dcc:content");
      printer_.PushAttribute("lang", "en");
      printer_.PushText(paragraph.c_str());
    }
  }
  static std::string stated(const std::string& text) { return text.empty() ? kNotStated : text; }
  std::string country() const {
    return issuer_.country.empty() ? kUnknownCountry : issuer_.country;
  }
  bool isDraft() const {
    const CertificateIssuer& i = issuer_;
    return i.laboratory.empty() || i.city.empty() || i.country.empty() || i.person.empty() ||
           i.customer.empty();
  }
  std::string identifier() const;
  void location(const std::string& city);

  void administrativeData();
  void coreData();
  void item();
  void people();
  void statements();
  void measurementResults();
  void methods();
  std::string bendInWords() const;
  void resultList();
  void uncertainties();
  void covarianceMatrix();

  const CalibrationSession& session_;
  const CalibrationOrigin& origin_;
  const CertificateIssuer& issuer_;
  GradedCalibration graded_;
  std::vector<Eigen::Index> places_;
  std::vector<ParameterEstimate> results_;
  Words open_;
  Eigen::MatrixXd covariance_;
  tinyxml2::XMLPrinter printer_;
};

std::string Certificate::identifier() const {
  if (!issuer_.identifier.empty()) {
    return issuer_.identifier;
  }
  const Actuator& actuator = session_.start().actuator;
  return actuator.name + (actuator.serial.empty() ? "" : "-" + actuator.serial) + "-" +
         origin_.date;
}

void Certificate::location(const std::string& city) {
  const Element element(printer_, "dcc:location");
  leaf("dcc:city", stated(city));
  leaf("dcc:countryCode", country());
}

void Certificate::coreData() {
  // YYYY-MM-DD of the date with time.
  constexpr std::size_t kDay = 10;
  const std::string day = origin_.date.substr(0, kDay);
  const Element element(printer_, "dcc:coreData");
  leaf("dcc:countryCodeISO3166_1", country());
  leaf("dcc:usedLangCodeISO639_1", "en");
  leaf("dcc:mandatoryLangCodeISO639_1", "en");
  leaf("dcc:uniqueIdentifier", identifier());
  leaf("dcc:beginPerformanceDate", day);
  leaf("dcc:endPerformanceDate", day);
  leaf("dcc:performanceLocation", "laboratory");
  leaf("dcc:issueDate", day);
}

void Certificate::item() {
  const Actuator& actuator = session_.start().actuator;
  const Element items(printer_, "dcc:items");
  const Element item(printer_, "dcc:item");
  content("dcc:name", {"multi-degree-of-freedom actuator " + actuator.name});
  leaf("dcc:model", actuator.name);
  const Element identifications(printer_, "dcc:identifications");
  const Element identification(printer_, "dcc:identification");
  leaf("dcc:issuer", "manufacturer");
  leaf("dcc:value", stated(actuator.serial));
  content("dcc:name", {"serial number"});
}

void Certificate::people() {
  {
    const Element laboratory(printer_, "dcc:calibrationLaboratory");
    const Element contact(printer_, "dcc:contact");
    content("dcc:name", {stated(issuer_.laboratory)});
    location(issuer_.city);
  }
  {
    const Element persons(printer_, "dcc:respPersons");
    const Element responsible(printer_, "dcc:respPerson");
    {
      const Element person(printer_, "dcc:person");
      content("dcc:name", {stated(issuer_.person)});
    }
    leaf("dcc:mainSigner", "true");
  }
  const Element customer(printer_, "dcc:customer");
  content("dcc:name", {stated(issuer_.customer)});
  location("");
}

/// What limits the results.
void Certificate::statements() {
  Words declarations = {"Grade " + gradeName(graded_.grade) + ". " + graded_.reason};
  if (!open_.empty()) {
    declarations.push_back("Not identified, and no part of these results: " + joined(open_) + ".");
  }
  if (isDraft()) {
    declarations.emplace_back(
        "Draft: not all of laboratory, place, person and customer are stated.");
  }
  const Element statements(printer_, "dcc:statements");
  const Element statement(printer_, "dcc:statement");
  content("dcc:declaration", declarations);
}

void Certificate::administrativeData() {
  const Element element(printer_, "dcc:administrativeData");
  {
    const Element all(printer_, "dcc:dccSoftware");
    const Element software(printer_, "dcc:software");
    content("dcc:name", {"spherical_actuator_calibration"});
    leaf("dcc:release", stated(origin_.software));
  }
  coreData();
  item();
  people();
  statements();
}

void Certificate::methods() {
  Words recordings;
  recordings.reserve(origin_.recordings.size());
  for (const RecordingSource& source : origin_.recordings) {
    recordings.push_back(source.recording + " (" + source.checksum + ")");
  }
  const Element methods(printer_, "dcc:usedMethods");
  const Element method(printer_, "dcc:usedMethod");
  content("dcc:name", {"Weighted least squares of all parameters from static dwells"});
  content("dcc:description",
          {"Recordings: " + (recordings.empty() ? kNotStated : joined(recordings)) + ".",
           format("Uncertainty by JCGM 100: expanded with the coverage factor k = %s for 95 %%, "
                  "from %d degrees of freedom of the residuals. Errors that samples of a dwell "
                  "share, and stated registrations, are part of it. Results are correlated: use "
                  "their covariance matrix wherever several of them are combined.",
                  factorText(coverageFactor(session_)).c_str(),
                  degreesOfFreedom(session_)) +
               bendInWords()});
}

/// The region of all results is an ellipsoid, and a wide turn in common bends it.
std::string Certificate::bendInWords() const {
  constexpr double kWide = 1e-2;  // [rad]; bent by 0.05 mrad, what differences are known to
  double widest = 0.0;
  for (const ParameterEstimate& result : results_) {
    widest = std::max(widest, result.unit == "rad" ? result.stddev : 0.0);
  }
  return widest <= kWide
             ? std::string()
             : format(
                   " Angles are known in common to %.2g mrad only, a turn that bends the region "
                   "of all results by more than it is thick: the intervals of single results "
                   "hold, the ellipsoid of all together does not.",
                   1e3 * widest);
}

void Certificate::uncertainties() {
  const double factor = coverageFactor(session_);
  const auto count = static_cast<std::size_t>(covariance_.rows());
  const Element univariate(printer_, "si:measurementUncertaintyUnivariateXMLList");
  const Element expanded(printer_, "si:expandedMUXMLList");
  leaf("si:valueExpandedMUXMLList", numbers(factor * covariance_.diagonal().cwiseSqrt()));
  leaf("si:coverageFactorXMLList", joined(Words(count, factorText(factor))));
  leaf("si:coverageProbabilityXMLList", joined(Words(count, kCoverage)));
  leaf("si:distributionXMLList", joined(Words(count, "normal")));
}

/// Column by column, with an ellipsoid that holds all results together.
void Certificate::covarianceMatrix() {
  constexpr double kProbability = 0.95;
  const Element multivariate(printer_, "si:measurementUncertaintyMultivariateXMLList");
  const Element region(printer_, "si:ellipsoidalRegionMUXMLList");
  {
    const Element matrix(printer_, "si:covarianceMatrixXMLList");
    for (Eigen::Index column = 0; column < covariance_.cols(); ++column) {
      const std::string& own = results_[static_cast<std::size_t>(column)].unit;
      Words units;
      units.reserve(results_.size());
      for (const ParameterEstimate& row : results_) {
        units.push_back(siProduct(row.unit, own));
      }
      const Element entry(printer_, "si:columnXMLList");
      const Element covariance(printer_, "si:covarianceXMLList");
      leaf("si:valueXMLList", numbers(covariance_.col(column)));
      leaf("si:unitXMLList", joined(units));
    }
  }
  const double limit = chiSquareLimit(static_cast<double>(results_.size()), 1.0 - kProbability);
  leaf("si:coverageFactorXMLList", factorText(std::sqrt(limit)));
  leaf("si:coverageProbabilityXMLList", kCoverage);
  leaf("si:distributionXMLList", "normal");
}

void Certificate::resultList() {
  Words names;
  Words units;
  Eigen::VectorXd values(covariance_.rows());
  for (std::size_t p = 0; p < results_.size(); ++p) {
    names.push_back(results_[p].name);
    units.push_back(siUnit(results_[p].unit));
    values[static_cast<Eigen::Index>(p)] = results_[p].value;
  }
  const Element list(printer_, "si:realListXMLList");
  leaf("si:labelXMLList", joined(names));
  leaf("si:valueXMLList", numbers(values));
  leaf("si:unitXMLList", joined(units));
  uncertainties();
  covarianceMatrix();
}

void Certificate::measurementResults() {
  const Element all(printer_, "dcc:measurementResults");
  const Element measurement(printer_, "dcc:measurementResult");
  content("dcc:name", {"Geometry of the actuator"});
  methods();
  const Element results(printer_, "dcc:results");
  const Element result(printer_, "dcc:result");
  content("dcc:name",
          {session_.start().actuator.has_joints
               ? "Offsets and axes of joints, angles of poles and coils"
               : "Angles of poles and coils"});
  const Element data(printer_, "dcc:data");
  const Element quantity(printer_, "dcc:quantity");
  content("dcc:name", {"Identified parameters, labelled by their names"});
  resultList();
}

}  // namespace

CertificateIssuer loadCertificateIssuer(const std::string& path) {
  const YamlMap file = YamlMap::parse(readInputFile(path, kLargestConfiguration), path);
  const YamlMap map = file.map("certificate");
  CertificateIssuer issuer;
  issuer.laboratory = map.text("laboratory", "");
  issuer.city = map.text("city", "");
  issuer.country = map.text("country", "");
  issuer.person = map.text("person", "");
  issuer.customer = map.text("customer", "");
  issuer.identifier = map.text("identifier", "");
  const auto is_letter = [](char letter) { return letter >= 'A' && letter <= 'Z'; };
  if (!issuer.country.empty() &&
      (issuer.country.size() != 2 ||
       !std::all_of(issuer.country.begin(), issuer.country.end(), is_letter))) {
    map.fail("country", "\"" + excerpt(issuer.country) + "\" is not a country code like DE.");
  }
  file.finish();
  return issuer;
}

std::string renderCertificate(const CalibrationSession& session,
                              const CalibrationOrigin& origin,
                              const CertificateIssuer& issuer) {
  return Certificate(session, origin, issuer).text();
}

}  // namespace sac

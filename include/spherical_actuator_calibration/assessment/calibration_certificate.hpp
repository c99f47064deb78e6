#pragma once

#include <string>

#include "spherical_actuator_calibration/calibration/calibration_session.hpp"

namespace sac {

/// What a certificate must name and no measurement tells. What is not stated is written as such,
/// and the certificate says that it is a draft.
struct CertificateIssuer {
  std::string laboratory;
  std::string city;
  std::string country;  ///< two letters, ISO 3166-1; empty: not stated
  std::string person;   ///< who is responsible
  std::string customer;
  std::string identifier;  ///< of the certificate; empty: made of unit and revision
};

/// Reads an issuer from a YAML file, `certificate: {laboratory: …, city: …, country: DE, person: …,
/// customer: …, identifier: …}`; every key may be left out. Throws ConfigError that names file,
/// line and key.
CertificateIssuer loadCertificateIssuer(const std::string& path);

/// Digital calibration certificate: XML of PTB's schema DCC 3.3, quantities in D-SI with the
/// covariance of all results. It holds the parameters that are identified; all others are named.
/// Coverage: 95 %, each with coverageFactor(); all together with the ellipsoid of JCGM 102.
/// Throws DataError when no parameter is identified.
std::string renderCertificate(const CalibrationSession& session,
                              const CalibrationOrigin& origin,
                              const CertificateIssuer& issuer);

}  // namespace sac

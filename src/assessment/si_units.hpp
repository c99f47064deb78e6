#pragma once

#include <string>

namespace sac {

/// A unit as D-SI writes it: "N·m·s/rad" gives "\newton\metre\second\radian\tothe{-1}", "1" gives
/// "\one". Throws DataError for a symbol that is not known here.
std::string siUnit(const std::string& unit);

/// The unit of a product of two quantities, likewise; each symbol stands once.
std::string siProduct(const std::string& a, const std::string& b);

}  // namespace sac

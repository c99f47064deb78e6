#pragma once

#include <map>
#include <string>

namespace sac {

/// Laboratory effects that a calibration models, by their names; the others are taken to be absent.
class EffectSelection {
 public:
  bool has(const std::string& effect) const { return (*this)[effect]; }
  bool& operator[](const std::string& effect) { return modelled_[effect]; }
  const bool& operator[](const std::string& effect) const;
  bool any() const;

  const std::map<std::string, bool>& all() const { return modelled_; }

 private:
  std::map<std::string, bool> modelled_;
};

}  // namespace sac

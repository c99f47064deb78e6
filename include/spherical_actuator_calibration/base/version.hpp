#pragma once

namespace sac {

/// Version of this package, as in its package.xml: "0.2.0".
const char* packageVersion();

}  // namespace sac

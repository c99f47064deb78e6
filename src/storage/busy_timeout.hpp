#pragma once

namespace sac {

/// How long another program, such as the sqlite3 shell, may hold up what is read or written [ms].
inline constexpr int kBusyTimeoutMilliseconds = 2000;

}  // namespace sac

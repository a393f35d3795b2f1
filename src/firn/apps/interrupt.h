#pragma once

namespace firn {

/// From now on SIGINT and SIGTERM end the program at once, with exit code 130: there is nothing to save yet.
void leave_at_interrupts();

/// From now on the first SIGINT or SIGTERM only sets a flag; a second one ends the program at once, with exit code 130.
void catch_interrupts();

/// Whether the user has asked to stop.
bool interrupted();

}  // namespace firn

// Parts of a Markdown page that a program writes, between marks.
#pragma once

#include <functional>
#include <string>

namespace ctu::sim::paper {

/// Throws Error unless the page can be read and has "<!-- begin: NAME -->" and, behind it, "<!-- end: NAME -->": asked
/// before long work, not after it.
void require_section(const std::string& page, const std::string& name);

/// Puts `text` between these marks, in place of what is there. Throws Error where require_section does, and when the
/// page cannot be written; then nothing is changed.
void put_section(const std::string& page, const std::string& name, const std::string& text);

/// What `write` prints to standard output, which is printed, too.
std::string printed_by(const std::function<void()>& write);

}  // namespace ctu::sim::paper

// How a call is refused.
#pragma once

#include <string>

#include "lfdtools/error.hpp"

/// How a call was refused; an empty id: it was not.
struct Refusal {
  lfd::Fault fault = lfd::Fault::internal;
  std::string id;
  std::string text;
  lfd::Place place;
};

template <class Call>
Refusal refusal_of(Call call) {
  try {
    call();
  } catch (const lfd::Error& error) {
    return {error.fault(), error.id(), error.what(), error.place()};
  }
  return {};
}

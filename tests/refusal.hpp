// How a call is refused.
#pragma once

#include <catch2/catch.hpp>
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

/// The id of that refusal, empty where there is none; one with another fault fails the test.
template <class Call>
std::string refused_as(lfd::Fault fault, Call call) {
  const Refusal refusal = refusal_of(call);
  INFO(refusal.id);
  if (!refusal.id.empty()) CHECK(refusal.fault == fault);
  return refusal.id;
}

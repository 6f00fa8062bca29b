#pragma once

/// @file
/// Hand-over of a closed contact between features as the rock moves over the slope.

#include "contact/Contact.h"
#include "contact/PlacedBlock.h"
#include "terrain/Surface.h"

namespace rockfall
{

/// Brings a closed contact to where the rock stands now: distance, normal, point. Where it has come
/// to the end of its feature it goes over to the neighbouring one, with its slip and without a jump
/// of force towards more. Returns false if it is gone: over the edge of the slope, or past its
/// feature with nothing there to take over.
bool refreshContact(const PlacedBlock& rock, const SurfacePatch& patch, Contact& contact);

/// One spring along the normal with the energy of two, where contacts have come to one place.
void joinSprings(Contact& contact, const Contact& other);

} // namespace rockfall

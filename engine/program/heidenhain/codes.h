// Names of the Q parameters of cycles. Lengths are in the program's units, feeds as F is written.
#pragma once

namespace swarf::program::nc::heidenhain {

struct Q {
  enum : int {
    kClearance = 200,        ///< set-up clearance above the surface
    kDepth = 201,            ///< below the surface, below zero
    kPeck = 202,             ///< plunging depth
    kSurface = 203,          ///< coordinate of the surface
    kSecondClearance = 204,  ///< height between holes
    kPeckMin = 205,          ///< least plunging depth
    kFeed = 206,             ///< for plunging
    kFeedOut = 208,          ///< for retraction; 0: kFeed
    kDwellAbove = 210,       ///< s
    kDwellBelow = 211,       ///< s
    kPeckLess = 212,         ///< by which each peck is smaller
    kBreaks = 213,           ///< chip breaks before a retraction
    kDisengaging = 214,      ///< direction in which an edge is freed
    kPitch = 239,            ///< of a thread
    kCounterbore = 249,      ///< depth of the counterbore
    kThickness = 250,        ///< of the material
    kEdgeAside = 251,        ///< off-centre distance of the edge
    kEdgeHeight = 252,       ///< of the tool
    kFeedPositioning = 253,
    kFeedCounterbore = 254,
    kDwellCounterbore = 255,  ///< s
    kChipBreakBack = 256,     ///< retraction for a chip break
    kChipBreakDepth = 257,    ///< way between two chip breaks
    kStopAboveFirst = 258,    ///< above the last depth, at the first retraction
    kStopAboveLast = 259,     ///< the same, at the last one
    kHelixDepth = 334,        ///< depth per turn of the helix
    kDiameter = 335,          ///< of the bore
    kPreset = 339,            ///< number of the preset
    kRoughDiameter = 342,     ///< of the bore that is there
    kByDiameter = 343,        ///< centring by diameter (1) or depth (0)
    kMillingSense = 351,      ///< +1 climb, -1 up-cut
    kFeedPilot = 253,         ///< down to the lowered starting point
    kStartPoint = 379,        ///< lowered starting point
    kDepthReference = 395,    ///< depth of the tip (0) or of the full diameter
    kFeedFactor = 401,        ///< %
    kEntrySense = 426,        ///< sense of rotation on the way in and out
    kEntrySpeed = 427,
    kDrillingSpeed = 428,
    kDwellDepth = 435,
  };
};

}  // namespace swarf::program::nc::heidenhain

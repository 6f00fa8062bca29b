#pragma once

/// @file
/// Properties that are lists of numbers, as ParaView sets them: one by one. A public header includes
/// it by its name alone.

/// Method `addOne` appends a number to the member `list`, `clearAll` empties it.
#define rockfallListPropertyMacro(list, type, addOne, clearAll)                                    \
  virtual void addOne(type number)                                                                 \
  {                                                                                                \
    this->list.push_back(number);                                                                  \
    this->Modified();                                                                              \
  }                                                                                                \
  virtual void clearAll()                                                                          \
  {                                                                                                \
    if (!this->list.empty())                                                                       \
    {                                                                                              \
      this->list.clear();                                                                          \
      this->Modified();                                                                            \
    }                                                                                              \
  }

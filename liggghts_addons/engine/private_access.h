// SPDX-License-Identifier: GPL-2.0-or-later
/* A way to private members of LIGGGHTS' classes, which hand out neither their models, nor their tables of styles, nor
   the flags of their histories. An explicit instantiation may name a private member: `template struct Opened<Key,
   &Class::member>`, with Key::type the type of that pointer, fills Handed<Key>::pointer. */
#ifndef VIELTO_OPEN_H
#define VIELTO_OPEN_H

namespace vielto {

template <class Key>
struct Handed {
  static typename Key::type pointer;
};
template <class Key>
typename Key::type Handed<Key>::pointer;

template <class Key, typename Key::type Member>
struct Opened {
  struct Fill {
    Fill() { Handed<Key>::pointer = Member; }
  };
  static Fill fill;
};
template <class Key, typename Key::type Member>
typename Opened<Key, Member>::Fill Opened<Key, Member>::fill;

}  // namespace vielto

#endif

// SPDX-License-Identifier: GPL-2.0-or-later
// The furo of Debian 12 has no dark colours for "auto": what the system asks for is taken when a page opens.
'use strict';
if (document.body.dataset.theme === 'auto' && window.matchMedia('(prefers-color-scheme: dark)').matches)
  document.body.dataset.theme = 'dark';

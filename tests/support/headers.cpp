// SPDX-License-Identifier: Apache-2.0
// Nothing of its own: a target needs a source, and this one is there for the headers that are compiled with it.

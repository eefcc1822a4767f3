// SPDX-License-Identifier: Apache-2.0
// Empty on purpose: the target of the precompiled headers needs a source file.

# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""`uel insert`: insert interface elements between the solids of a mesh, with duplicated nodes."""

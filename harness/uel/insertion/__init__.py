# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""`uel insert`: interface elements between the solids of a mesh, whose nodes are doubled where it is cut."""

//! The macro that generates the types [`super::Surface`] and [`super::Bsdf`] from one list of models.

/// Each row is `Variant(what the surface holds) from Model => what it is at a point,` under a line of documentation. The model is a
/// [`super::model::SurfaceModel`]; at a point it becomes a [`super::model::BsdfModel`]. Two members are no models and stand here: a surface
/// that scatters nothing, and a mix, which scatters by its parts alone.
macro_rules! surfaces {
    ($( $(#[doc = $doc:literal])* $variant:ident($held:ty) from $model:ty => $bsdf:ty, )*) => {
        /// Scattering model of a surface.
        #[derive(Clone, Debug, PartialEq)]
        pub enum Surface {
            /// All light that arrives is absorbed: a pure emitter, or black.
            Absorber,
            $( $(#[doc = $doc])* $variant($held), )*
            /// Two materials side by side.
            Mix(Mix),
        }

        $(
            impl From<$model> for Surface {
                fn from(model: $model) -> Self {
                    Self::$variant(model.into())
                }
            }
        )*

        impl Surface {
            fn parameters(&self) -> Vec<Parameter<'_>> {
                match self {
                    Self::Absorber => Vec::new(),
                    $( Self::$variant(model) => model.parameters(), )*
                    Self::Mix(mix) => mix.parameters(),
                }
            }

            #[inline]
            fn passage(&self) -> Passage<'_> {
                match self {
                    Self::Absorber | Self::Mix(_) => Passage::None,
                    $( Self::$variant(model) => model.passage(), )*
                }
            }

            fn check_energy(&self, check: &TextureCheck<'_>) -> Result<(), MaterialError> {
                match self {
                    Self::Absorber | Self::Mix(_) => Ok(()),
                    $( Self::$variant(model) => model.check_energy(check), )*
                }
            }

            #[inline]
            fn straight_transmittance<const N: usize>(&self, point: &ShadingPoint<'_, N>, cos: f32) -> Spectral<N> {
                match self {
                    Self::Absorber | Self::Mix(_) => Spectral::ZERO,
                    $( Self::$variant(model) => model.straight_transmittance(point, cos), )*
                }
            }

            #[inline]
            fn resolve<const N: usize>(&self, point: &ShadingPoint<'_, N>) -> Bsdf<'_, N> {
                match self {
                    Self::Absorber => Bsdf::Absorber,
                    $( Self::$variant(model) => Bsdf::$variant(model.resolve(point)), )*
                    Self::Mix(_) => panic!("a mix scatters by its parts alone: resolve it first"),
                }
            }
        }

        /// Scattering at one point, at the wavelengths of one path.
        #[derive(Clone, Copy, Debug)]
        pub enum Bsdf<'a, const N: usize> {
            /// Nothing is scattered.
            Absorber,
            $( $(#[doc = $doc])* $variant($bsdf), )*
        }

        impl<const N: usize> Bsdf<'_, N> {
            #[inline]
            fn flags(&self) -> BsdfFlags {
                match self {
                    Self::Absorber => BsdfFlags { delta: false, transmits: false, has_parts: false },
                    $( Self::$variant(bsdf) => BsdfModel::<N>::flags(bsdf), )*
                }
            }

            /// True if light continues in exact directions only, so that light sampling is useless.
            #[must_use]
            #[inline]
            pub fn is_delta(&self) -> bool {
                self.flags().delta
            }

            /// True if light may come from behind (wi.z < 0) by a finite density.
            #[must_use]
            #[inline]
            pub fn transmits(&self) -> bool {
                self.flags().transmits
            }

            /// True if [`Bsdf::sample`] uses the number that selects a lobe.
            #[must_use]
            #[inline]
            pub fn has_parts(&self) -> bool {
                self.flags().has_parts
            }

            /// Value and density of a pair of directions; zero if `wo` is behind the surface, or light from `wi` is not transmitted.
            #[must_use]
            pub fn evaluate(&self, wo: Vec3, wi: Vec3) -> BsdfValue<N> {
                if wo.z <= 0.0 || wi.z == 0.0 || (wi.z < 0.0 && !self.transmits()) {
                    return BsdfValue::ZERO;
                }
                match self {
                    Self::Absorber => BsdfValue::ZERO,
                    $( Self::$variant(bsdf) => bsdf.evaluate(wo, wi), )*
                }
            }

            /// Data for light selection, for the viewer's direction `wo`.
            #[inline]
            pub(crate) fn gloss(&self, wo: Vec3) -> Gloss {
                match self {
                    Self::Absorber => Gloss::MATT,
                    $( Self::$variant(bsdf) => BsdfModel::<N>::gloss(bsdf, wo), )*
                }
            }

            /// Samples a direction for light to come from; `None` if the light is absorbed. `choice` selects a lobe, `u` a direction; both
            /// are uniform in [0, 1).
            #[must_use]
            pub fn sample(&self, wo: Vec3, choice: f32, u: Vec2) -> Option<BsdfSample<N>> {
                if wo.z <= 0.0 {
                    return None;
                }
                match self {
                    Self::Absorber => None,
                    $( Self::$variant(bsdf) => bsdf.sample(wo, choice, u), )*
                }
            }
        }
    };
}

pub(super) use surfaces;

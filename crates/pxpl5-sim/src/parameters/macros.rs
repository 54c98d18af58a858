//! The macro that declares a table of parameters.

/// Declares a struct of parameters. Each parameter has an initial value, unit, provenance, range, limits and source.
///
/// The upper limit can be written as `MAX`, which stands for [`MAX`](crate::parameters::MAX). The calling crate must
/// depend on `serde`, because the macro makes the table serializable by parameter names. Deserialization rejects
/// unknown names.
///
/// ```
/// pxpl5_sim::parameters::parameter_table! {
///     /// A channel and the tracker behind it.
///     pub struct Channel {
///         /// Time of one word.
///         word_ns: 50, "ns", Published, 50..=50 in 1..=1_000_000, "TR94";
///         /// Error of each axis, rms.
///         position_noise: f64 = 2.5, "mm", Published, 0.0..=5.0, "data sheet";
///     }
/// }
/// use pxpl5_sim::parameters::ParameterTable;
/// let mut channel = Channel::PAPERS;
/// channel.set("word_ns", 100.into()).unwrap();
/// assert_eq!((channel.word_ns, channel.position_noise), (100, 2.5));
/// assert_eq!(channel.out_of_range()[0].info.name, "word_ns");
/// assert!(channel.check().is_ok());
/// ```
#[macro_export]
macro_rules! parameter_table {
    ($(#[$meta:meta])* $vis:vis struct $name:ident {
        $(
            $(#[$doc:meta])*
            $field:ident : $($real:ident =)? $value:literal, $unit:literal, $provenance:ident,
            $low:literal ..= $high:literal $(in $least:literal ..= $most:tt)?, $source:literal;
        )*
    }) => {
        $(#[$meta])*
        #[derive(Clone, Copy, Debug, ::serde::Serialize, ::serde::Deserialize)]
        #[serde(deny_unknown_fields)]
        $vis struct $name {
            $(
                $(#[$doc])*
                #[doc = concat!(
                    "\n\nUnit: ", $unit, ". ", stringify!($provenance), ", ", stringify!($low), " to ", stringify!($high),
                    $(" (possible: ", stringify!($least), " to ", stringify!($most), ")",)? ": ", $source, "."
                )]
                pub $field: $crate::number!(type $($real)?),
            )*
        }

        impl $name {
            /// The initial values of all parameters. The papers print or allow these values.
            $vis const PAPERS: Self = Self { $($field: $value,)* };

            /// Unit, provenance, range and source of each parameter, in the order of the declaration.
            $vis const INFOS: &'static [$crate::parameters::ParameterInfo] = &[$($crate::parameters::ParameterInfo {
                name: stringify!($field),
                unit: $unit,
                provenance: $crate::parameters::Provenance::$provenance,
                papers: $crate::number!(value $($real)? : $value),
                range: $crate::number!(pair $($real)? : $low, $high),
                limits: $crate::number!(pair $($real)? : $low, $high $(, $least, $most)?),
                source: $source,
            },)*];
        }

        impl $crate::parameters::ParameterTable for $name {
            fn infos(&self) -> &'static [$crate::parameters::ParameterInfo] {
                Self::INFOS
            }

            fn get(&self, name: &str) -> ::core::result::Result<$crate::parameters::Value, $crate::parameters::SettingError> {
                match name {
                    $(stringify!($field) => ::core::result::Result::Ok(self.$field.into()),)*
                    _ => ::core::result::Result::Err($crate::parameters::unknown_parameter(name, Self::INFOS)),
                }
            }

            fn set(
                &mut self,
                name: &str,
                value: $crate::parameters::Value,
            ) -> ::core::result::Result<(), $crate::parameters::SettingError> {
                match name {
                    $(stringify!($field) => $crate::parameters::Number::assign(&mut self.$field, stringify!($field), value),)*
                    _ => ::core::result::Result::Err($crate::parameters::unknown_parameter(name, Self::INFOS)),
                }
            }

            // The comparison uses constants and looks up no names, because programs check many machines.
            fn check(&self) -> ::core::result::Result<(), $crate::parameters::SettingError> {
                $($crate::parameters::check_value(
                    stringify!($field),
                    self.$field.into(),
                    $crate::number!(pair $($real)? : $low, $high $(, $least, $most)?),
                )?;)*
                ::core::result::Result::Ok(())
            }
        }

        impl ::core::cmp::PartialEq for $name {
            fn eq(&self, other: &Self) -> bool {
                true $(&& $crate::parameters::Value::from(self.$field) == $crate::parameters::Value::from(other.$field))*
            }
        }

        impl ::core::cmp::Eq for $name {}

        impl ::core::hash::Hash for $name {
            fn hash<H: ::core::hash::Hasher>(&self, state: &mut H) {
                $(::core::hash::Hash::hash(&$crate::parameters::Value::from(self.$field), state);)*
            }
        }
    };
}

/// Expands to the type or value of a parameter: a whole number, or a real number if the declaration contains `f64`.
#[doc(hidden)]
#[macro_export]
macro_rules! number {
    (type) => { u64 };
    (type f64) => { f64 };
    (value : $value:literal) => { $crate::parameters::Value::Whole($value) };
    (value f64 : $value:literal) => { $crate::parameters::Value::Real($value) };
    (pair : $low:literal, $high:literal) => { ($crate::parameters::Value::Whole($low), $crate::parameters::Value::Whole($high)) };
    (pair f64 : $low:literal, $high:literal) => { ($crate::parameters::Value::Real($low), $crate::parameters::Value::Real($high)) };
    // If a line has limits, they replace the range.
    (pair $($real:ident)? : $low:literal, $high:literal, $least:literal, MAX) => {
        ($crate::parameters::Value::Whole($least), $crate::parameters::Value::Whole($crate::parameters::MAX))
    };
    (pair $($real:ident)? : $low:literal, $high:literal, $least:literal, $most:literal) => {
        $crate::number!(pair $($real)? : $least, $most)
    };
}
